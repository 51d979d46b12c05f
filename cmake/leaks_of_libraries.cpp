// SPDX-License-Identifier: GPL-3.0-or-later
// What the leak checker finds in libraries that are not ours, seen in programs that do nothing: CLN (below
// GiNaC) keeps 26 bytes of its start-up to the end, the Fortran runtime below LAPACK seven. Everything else
// that leaks is still reported.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libcln.so\nleak:libgfortran.so\n"; }
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
