// SPDX-License-Identifier: GPL-3.0-or-later
// The leak checker does not watch what shared libraries allocate at their start: CLN (below GiNaC) keeps 26
// bytes to the end, the Fortran runtime below LAPACK seven, in programs that do nothing as well. Everything
// after that is reported. A list of suppressions would do, but to compare a leak with it the checker reads
// the symbols of the whole program: 0.4 s of a processor at each end of `vernier`.
extern "C" void __lsan_disable();
extern "C" void __lsan_enable();

namespace {

// Functions of .preinit_array run before the constructors of shared libraries, and after the start of the
// address sanitizer, which the linker puts first.
using Function = void (*)(int, char**, char**);
void libraries_start(int, char**, char**) { __lsan_disable(); }
[[gnu::section(".preinit_array"), gnu::used]] const Function kLibrariesStart = libraries_start;

// Constructors of the program run after those of its libraries; this is the first of them.
[[gnu::constructor(101)]] void libraries_have_started() { __lsan_enable(); }

}  // namespace
