# SPDX-License-Identifier: GPL-3.0-or-later
# The preset `debug` takes clang: its objects under sanitizers cost half of what they cost with GCC.
if(VERNIER_SANITIZE)
  # A null or dangling pointer ends in the address sanitizer's hands anyway; asking before every access of Eigen's costs a third of the
  # compile time.
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-sanitize=null,alignment,object-size,vptr
    $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=pointer-overflow>  # Eigen steps over empty matrices, whose data is null
    -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
  add_compile_definitions(VERNIER_SANITIZED)
endif()
if(VERNIER_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "VERNIER_BUILD_FUZZERS needs clang (-DCMAKE_CXX_COMPILER=clang++); fuzz_plain does without")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-sanitize=vptr -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()

# A program's leak checker passes over what libraries that are not ours keep.
function(vernier_forgive_libraries target)
  if(VERNIER_SANITIZE)
    target_sources(${target} PRIVATE ${CMAKE_SOURCE_DIR}/cmake/leaks_of_libraries.cpp)
  endif()
endfunction()
