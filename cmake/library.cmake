# SPDX-License-Identifier: GPL-3.0-or-later
# A clean build takes a third of the time where a handful of sources is one object: what their headers instantiate is
# compiled once. The preset `dev` leaves it off, so that one changed source is one object.
option(VERNIER_UNITY "Compile the sources of a target in groups" OFF)
function(vernier_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${VERNIER_UNITY} UNITY_BUILD_BATCH_SIZE 16)
endfunction()

# Rooms that read, write and print, and nothing that a measurement waits for: an optimiser costs more there than it saves.
set(VERNIER_ROOMS_OF_GLUE create import lint exchange evaluate report results upload workbench fleet commands python)
# Under sanitizers an object costs half without an optimiser (measured with clang 14: diagnose 15.8 s of 39.4). Only where tests multiply
# matrices and walk records, it earns that back: ControllerFiles.* take 1000 s without.
set(VERNIER_ROOMS_OF_NUMBERS comp firmware maths model fit kinematics vibration timebase tolerance)
# In a short run the sanitizers look at what reads bytes of others and at what is on the board. Release tests the rest, whose objects may be
# slow here, and has the only command line program.
set(VERNIER_SHORT_SANITIZE OFF)
# Rooms of numbers that none of its tests is about: they are linked as they are, which costs half of their objects.
set(VERNIER_ROOMS_UNWATCHED)
if(VERNIER_SANITIZE AND VERNIER_TESTS STREQUAL "once")
  set(VERNIER_SHORT_SANITIZE ON)
  list(REMOVE_ITEM VERNIER_ROOMS_OF_NUMBERS maths fit kinematics vibration timebase tolerance)
  set(VERNIER_ROOMS_UNWATCHED maths fit kinematics vibration timebase tolerance effects compile check part)
endif()

# Rooms whose tests compute themselves, with templates of their own objects: a survey is diagnosed 20 times slower without an optimiser.
set(VERNIER_ROOMS_OF_LONG_TESTS diagnose effects fit kinematics maths plan residual)

# vernier_effort(target room): how hard the compiler tries, and what it has read before. `tests`: not at all.
function(vernier_effort target room)
  set(headers vernier_headers)
  if(room STREQUAL "tests" OR VERNIER_SANITIZE AND NOT room IN_LIST VERNIER_ROOMS_OF_NUMBERS)
    target_compile_options(${target} PRIVATE -O0)
    set(headers vernier_headers_unoptimised)
    if(room IN_LIST VERNIER_ROOMS_UNWATCHED)
      target_compile_options(${target} PRIVATE -fno-sanitize=all)
      set(headers vernier_headers_unwatched)
    endif()
  elseif(room IN_LIST VERNIER_ROOMS_OF_GLUE)
    # Seen without inlining, a number that is there on one condition "may be uninitialized" on the same one further down.
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  endif()
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "EXECUTABLE" AND TARGET ${headers}_pie)
    string(APPEND headers _pie)
  endif()
  # A module of Python hides its names, which the headers do not.
  if(TARGET ${headers} AND NOT type STREQUAL "MODULE_LIBRARY")
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
endfunction()

# vernier_library(folder PUBLIC a b PRIVATE c SOURCES more.cpp): vernier_<folder>, a static library of all sources in this
# folder and of those generated for it.
function(vernier_library name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE;SOURCES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp ${CMAKE_CURRENT_SOURCE_DIR}/*/*.cpp)
  add_library(vernier_${name} STATIC ${sources} ${ARG_SOURCES})
  vernier_unity(vernier_${name})
  target_link_libraries(vernier_${name} PUBLIC vernier_warnings ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  vernier_effort(vernier_${name} ${name})
endfunction()
