#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: sparkplug_client.py BIN_DIR

What a gateway publishes, heard by mosquitto_sub and read by Eclipse Tahu's own decoder (npm `sparkplug-payload`, sparkplug_judge.mjs): topics, births before
data, every name and type of data promised by its birth, sequence numbers without a gap, bdSeq of birth and will, historical values after the
host was away. Meanwhile the gateway, a board's process and the host are killed."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../../bench/fleet"))
import argparse  # noqa: E402

from services import Service, programs_missing  # noqa: E402
from soak import Fleet  # noqa: E402


def main():
    missing = programs_missing("sqlite")
    missing += [name for name in ("mosquitto_sub", "node") if not shutil.which(name)]
    if not os.path.isdir(os.path.join(HERE, "node_modules/sparkplug-payload")):
        missing.append("sparkplug-payload (npm ci --prefix tests/unit/fleet)")
    if missing:
        print(f"sparkplug_client: Skipped\nnot installed: {' '.join(missing)}")
        return 77
    folder = tempfile.mkdtemp(prefix="vernier_sparkplug_")
    fleet = Fleet(argparse.Namespace(bin=sys.argv[1], boards=4, gateways=1, database="sqlite"), folder)
    heard = os.path.join(folder, "heard")
    port = fleet.broker.command and open(os.path.join(folder, "mosquitto.conf")).read().split()[1]
    listener = Service("listener", ["mosquitto_sub", "-p", port, "-q", "1", "-t", "spBv1.0/#", "-F", "%t\t%q\t%r\t%x"], heard)
    everything = [fleet.broker, listener, fleet.ingest, *fleet.board_processes, *fleet.gateways]
    try:
        fleet.enter_machines()
        fleet.start(fleet.broker)
        time.sleep(0.5)
        for one in everything[1:]:
            fleet.start(one)
        time.sleep(4)
        fleet.board_processes[0].kill()
        time.sleep(1.5)
        fleet.start(fleet.board_processes[0])
        time.sleep(2.5)
        fleet.ingest.kill()
        time.sleep(7.5)  # samples become old
        fleet.start(fleet.ingest)
        time.sleep(2)
        fleet.gateways[0].kill()
        time.sleep(0.5)
        fleet.start(fleet.gateways[0])
        time.sleep(3.5)
        fleet.gateways[0].end()
        time.sleep(0.5)
    finally:
        for one in everything:
            if one.process is not None and one.process.poll() is None:
                one.kill()
    result = subprocess.run(["node", os.path.join(HERE, "sparkplug_judge.mjs"), heard], capture_output=True, text=True)
    print(result.stdout, result.stderr)
    if result.returncode == 0:
        shutil.rmtree(folder, ignore_errors=True)
        counts = json.loads(result.stdout.splitlines()[-1])
        # Two hosts' absences and two starts of the gateway; each kind was heard.
        needed = {"NBIRTH": 3, "NDEATH": 2, "DBIRTH": 8, "DDEATH": 4, "DDATA": 20, "historical": 1, "NCMD": 5, "STATE": 3}
        wrong = [f"{key}: {counts.get(key, 0)} of {least}" for key, least in needed.items() if counts.get(key, 0) < least]
        print("\n".join(wrong))
        return 1 if wrong else 0
    print(f"kept: {folder}")
    return 1


if __name__ == "__main__":
    sys.exit(main())
