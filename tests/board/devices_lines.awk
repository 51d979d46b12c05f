# SPDX-License-Identifier: GPL-3.0-or-later
# Decodes what the emulator says of the board's lines ("IRQ raise N", "IRQ lower N"). The converter takes 16 bits at the rising
# clock while its select line is low: bit 15 the channel, bits 0..11 the code. A message that is not 16 bits long is an error.
# show=codes: each code as "CHANNEL CODE"; show=pulse: of each period of line 4 "ON PERIOD", in converter messages of channel 0,
# which the daemon sends once a tick; show=steps: the largest step of each channel, and how many codes there were.
BEGIN { level[2] = 1 }
$1 != "IRQ" { next }
{
  line = $3
  level[line] = $2 == "raise" ? 1 : 0
  if (line == 0 && level[0] && !level[2]) { bits = 2 * bits + level[1]; ++count }
  if (line == 2 && !level[2]) { bits = 0; count = 0 }
  if (line == 2 && level[2] && count > 0) message()
  if (line == 4 && show == "pulse") pulse()
}
function message(channel, code) {
  if (count != 16) { print "message of " count " bits"; bad = 1 }
  channel = int(bits / 32768) % 2
  code = bits % 4096
  if (channel == 0) ++ticks
  if (show == "codes") print channel, code
  if (channel in last && code - last[channel] > most[channel]) most[channel] = code - last[channel]
  if (channel in last && last[channel] - code > most[channel]) most[channel] = last[channel] - code
  last[channel] = code
  ++codes[channel]
}
function pulse() {
  if (level[4]) {
    if (rising != "") print on, ticks - rising
    rising = ticks
  } else if (rising != "") on = ticks - rising
}
END {
  if (show == "steps") print codes[0] + 0, most[0] + 0, codes[1] + 0, most[1] + 0
  exit bad
}
