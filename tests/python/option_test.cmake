# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DSOURCE=checkout -DWORK=folder -DGENERATOR=… -DMAKE_PROGRAM=… -P option_test.cmake: a checkout that was configured before pybind11 was there builds
# the Python module once it is. pybind11 is a stand-in: a folder with a package file.
file(REMOVE_RECURSE ${WORK})
file(WRITE ${WORK}/source/CMakeLists.txt "cmake_minimum_required(VERSION 3.22)
project(option NONE)
set(VERNIER_BUILD_TOOLS ON)
include(${SOURCE}/cmake/python.cmake)
message(STATUS \"module: \${VERNIER_BUILD_PYTHON}\")
")

function(expect_module wanted)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/source -B ${WORK}/build -G ${GENERATOR}
    -DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM} -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF
    -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF -DCMAKE_FIND_USE_CMAKE_ENVIRONMENT_PATH=OFF
    -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF -DCMAKE_FIND_USE_SYSTEM_PACKAGE_REGISTRY=OFF -DCMAKE_PREFIX_PATH=${WORK}/package
    ${ARGN} OUTPUT_VARIABLE text ERROR_VARIABLE errors RESULT_VARIABLE status)
  if(NOT status EQUAL 0 OR NOT text MATCHES "module: ${wanted}\n")
    message(FATAL_ERROR "wanted \"module: ${wanted}\" of ${ARGN}, got\n${text}${errors}")
  endif()
endfunction()

expect_module(OFF)
file(WRITE ${WORK}/package/share/cmake/pybind11/pybind11Config.cmake "set(pybind11_FOUND TRUE)\n")
expect_module(ON)
expect_module(OFF -DVERNIER_PYTHON=OFF)
expect_module(ON -DVERNIER_PYTHON=AUTO)
file(REMOVE_RECURSE ${WORK})
