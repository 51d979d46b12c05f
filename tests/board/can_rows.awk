# SPDX-License-Identifier: GPL-3.0-or-later
# Checks a recording of the emulated board; what: positions or corrections. Fails on a row that is wrong, and on too few.
# Positions: the controller sends Y = -X/2; a tick between its two frames finds Y one cycle (10 um) behind.
# Corrections: -X/10000 and -Y/5000 to 5 nm: rounding to 1 nm, the bound of the image, 1/(1+k).
BEGIN { FS = "," }
/^#/ { next }
!named { for (i = 1; i <= NF; ++i) column[$i] = i; named = 1; next }
{
  ++rows
  x = $column["X[mm]"]; y = $column["Y[mm]"]
  if (what == "positions") {
    between = size(y + x / 2)
    if (between > 0.010001 || size(x) > 30.000001) fail()
    if (between < 0.000001) ++exact
    if (rows == 1 || x < low) low = x
    if (rows == 1 || x > high) high = x
  } else if (size($column["correctionX[mm]"] + x / 10000) > 0.000005 || size($column["correctionY[mm]"] + y / 5000) > 0.000005) fail()
}
function size(a) { return a < 0 ? -a : a }
function fail() { if (!bad) print "row " rows ": " $0; bad = 1 }
END {
  print rows " rows, " exact + 0 " exact, X over " high - low " mm"
  if (what == "positions" && (exact < 0.8 * rows || high - low < 5)) exit 1
  exit bad || rows < 100
}
