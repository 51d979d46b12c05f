# SPDX-License-Identifier: GPL-3.0-or-later
# Cross build for an arm64 edge board (Debian's crossbuild-essential-arm64 and :arm64 libraries). Tests run under
# user-mode emulation, which GoogleTest's discovery uses at build time too.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

# Headers and packages are in the host's tree under Debian's multiarch paths; programs are always the host's.
set(CMAKE_FIND_ROOT_PATH /usr/aarch64-linux-gnu /usr)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY BOTH)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE BOTH)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)

find_program(vernier_arm64_pkg_config aarch64-linux-gnu-pkg-config)
if(vernier_arm64_pkg_config)
  set(PKG_CONFIG_EXECUTABLE ${vernier_arm64_pkg_config})
endif()
find_program(vernier_arm64_emulator qemu-aarch64-static)
if(vernier_arm64_emulator)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${vernier_arm64_emulator})
endif()

# A tree of arm64 packages that are not installed on this machine (tests/board/fetch makes one).
if(DEFINED ENV{VERNIER_ARM64_ROOT})
  set(vernier_arm64_root $ENV{VERNIER_ARM64_ROOT})
  list(APPEND CMAKE_FIND_ROOT_PATH ${vernier_arm64_root})
  set(ENV{PKG_CONFIG_LIBDIR} ${vernier_arm64_root}/usr/lib/aarch64-linux-gnu/pkgconfig)
  set(ENV{PKG_CONFIG_SYSROOT_DIR} ${vernier_arm64_root})
  set(CMAKE_CXX_FLAGS_INIT "-isystem ${vernier_arm64_root}/usr/include")
  set(CMAKE_EXE_LINKER_FLAGS_INIT
    "-L${vernier_arm64_root}/usr/lib/aarch64-linux-gnu -Wl,-rpath-link,${vernier_arm64_root}/usr/lib/aarch64-linux-gnu")
endif()
