#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: metrics.py BIN_DIR

`vernier fleet metrics` of a registry with odd names, printed and served, judged by Prometheus' promtool."""

import json
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import urllib.request

vernier = os.path.join(sys.argv[1], "vernier")
if not shutil.which("promtool"):
    print("metrics: Skipped\nnot installed: promtool (prometheus)")
    sys.exit(77)
folder = tempfile.mkdtemp(prefix="vernier_metrics_")
registry = os.path.join(folder, "fleet.db")
odd = 'O\'Brien "7"\\n \u00b5'
for name in ("plain", odd):
    subprocess.run([vernier, "fleet", "add", "new", "--registry", registry, "--check-days", "7"], check=True)
    with sqlite3.connect(registry) as file:  # an older version took any name
        file.execute("UPDATE machine SET name = ? WHERE name = 'new'", (name,))
with sqlite3.connect(registry) as file:
    file.execute("INSERT INTO shape VALUES ('s', ?)", (json.dumps(["Axes/X/Position", "Board/Mode", "Shares/X/a \"b\"\nc"]),))
    for name in ("plain", odd):
        file.execute("INSERT INTO live (machine, gateway, online, at_us, samples, mode, fault, image, shape, sample_values) "
                     "VALUES (?, 'g', 1, 1700000000000000, 12, 'active', 'none', '0123', 's', ?)",
                     (name, json.dumps([1.5e-7, "active", -3])))
        file.execute("INSERT INTO fault_event VALUES (?, 5, 'position-jump')", (name,))
    file.execute("INSERT INTO loss VALUES ('x', 3, 9)")
    file.execute("INSERT INTO answer VALUES ('id', 'plain', 'night', 1, 2, '{}')")
    file.execute("INSERT INTO not_entered VALUES (?, 'g', 7, 1)", (odd,))
text = subprocess.run([vernier, "fleet", "metrics", "--registry", registry], check=True, capture_output=True).stdout
server = subprocess.Popen([vernier, "fleet", "metrics", "--registry", registry, "--listen", "127.0.0.1:0"], stderr=subprocess.PIPE, text=True)
try:
    address = server.stderr.readline().strip()
    served = urllib.request.urlopen(address, timeout=20).read()
finally:
    server.terminate()
status = server.wait()
good = status == 0
for one in (text, served):
    result = subprocess.run(["promtool", "check", "metrics"], input=one, capture_output=True)
    print(result.stdout.decode(), result.stderr.decode())
    good = good and result.returncode == 0 and not result.stderr and b'vernier_lost_samples_total 5' in one
    good = good and b'vernier_batch_answers{batch="night",status="2"} 1' in one and b"vernier_not_entered_samples_total{" in one
    good = good and b'vernier_machine_online{machine="plain",gateway="g"} 0' in one  # nothing was heard lately
    good = good and b'vernier_machine_value{machine="plain",name="Axes/X/Position"} 1.5e-07' in one or b"1.5e-7" in one
shutil.rmtree(folder)
print("good" if good else text.decode())
sys.exit(0 if good else 1)
