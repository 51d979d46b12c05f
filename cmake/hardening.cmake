# SPDX-License-Identifier: GPL-3.0-or-later
# What runs on a board and listens there is built to be hard to misuse: stack protectors, checked library calls, and nothing
# that is linked can be written over (full RELRO). The same source gives the same bytes wherever it stands.
function(vernier_harden_folder)
  if(VERNIER_SANITIZE OR VERNIER_BUILD_FUZZERS OR CMAKE_SYSTEM_NAME STREQUAL "Generic")
    return()
  endif()
  add_compile_options(-fstack-protector-strong -fstack-clash-protection -ffile-prefix-map=${CMAKE_SOURCE_DIR}=.
    $<$<CONFIG:Release>:-U_FORTIFY_SOURCE> $<$<CONFIG:Release>:-D_FORTIFY_SOURCE=2>)
endfunction()
function(vernier_harden target)
  if(NOT VERNIER_SANITIZE AND NOT VERNIER_BUILD_FUZZERS)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_options(${target} PRIVATE -pie -Wl,-z,relro,-z,now,-z,noexecstack)
  endif()
endfunction()
