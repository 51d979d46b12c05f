# SPDX-License-Identifier: GPL-3.0-or-later
if(VERNIER_SANITIZE)
  # A null or dangling pointer ends in the address sanitizer's hands anyway; asking before every access of Eigen's costs a third of the
  # compile time.
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-sanitize=null,alignment,object-size,vptr
    -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
if(VERNIER_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "VERNIER_BUILD_FUZZERS needs clang (-DCMAKE_CXX_COMPILER=clang++); fuzz_plain does without")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-sanitize=vptr -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
