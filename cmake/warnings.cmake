# SPDX-License-Identifier: GPL-3.0-or-later
# Every target of the project links vernier_warnings; third-party headers are SYSTEM and stay out of it.
add_library(vernier_warnings INTERFACE)
# Warnings are the business of the builds that ship: the readers for libFuzzer are clang's, which has others.
if(NOT VERNIER_BUILD_FUZZERS)
  target_compile_options(vernier_warnings INTERFACE
    -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Werror)
endif()
target_include_directories(vernier_warnings INTERFACE ${CMAKE_SOURCE_DIR})

# GCC 12 sees overlapping copies in std::string operator+ that are not there (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(vernier_warnings INTERFACE -Wno-restrict)
endif()
