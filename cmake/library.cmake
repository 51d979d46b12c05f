# SPDX-License-Identifier: GPL-3.0-or-later
# A clean build takes a third of the time where a handful of sources is one object: what their headers instantiate is
# compiled once. The preset `dev` leaves it off, so that one changed source is one object.
option(VERNIER_UNITY "Compile the sources of a target in groups" OFF)
function(vernier_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${VERNIER_UNITY} UNITY_BUILD_BATCH_SIZE 16)
endfunction()

# vernier_library(folder PUBLIC a b PRIVATE c SOURCES more.cpp): vernier_<folder>, a static library of all sources in this
# folder and of those generated for it.
function(vernier_library name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE;SOURCES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_library(vernier_${name} STATIC ${sources} ${ARG_SOURCES})
  vernier_unity(vernier_${name})
  target_link_libraries(vernier_${name} PUBLIC vernier_warnings ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  if(VERNIER_SANITIZE AND "${name}" IN_LIST VERNIER_ROOMS_OF_TEXT)
    target_compile_options(vernier_${name} PRIVATE -O0)
  endif()
endfunction()
