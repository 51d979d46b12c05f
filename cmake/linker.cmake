# SPDX-License-Identifier: GPL-3.0-or-later
# A linker that takes two thirds of the time, where it is installed (package lld).
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND NOT CMAKE_CROSSCOMPILING)
  find_program(VERNIER_LLD ld.lld)
  if(VERNIER_LLD)
    add_link_options(-fuse-ld=lld)
  endif()
endif()
