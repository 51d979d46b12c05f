// SPDX-License-Identifier: GPL-3.0-or-later
// The dense form without jumps, in place of that of the library.
#define VERNIER_LOOPS
#include "comp/dense.cpp"
