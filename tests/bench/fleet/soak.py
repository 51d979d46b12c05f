#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: soak.py BIN_DIR [--boards 500] [--gateways 10] [--seconds 300] [--seed 1] [--kills 40] [--database postgres|sqlite]

Simulated boards (real link and service, tests/bench/fleet/fleet_boards.cpp) are read by real gateways over Modbus, a sample of more
than twenty values a second each; broker, database, ingest, gateways and boards' processes are killed (SIGKILL) at moments and for
times drawn from the seed. Afterwards everything is let run dry, and the registry is compared with what the boards' own journals say that they told:
nothing lost, nothing twice, nothing given to another machine, every value as it was told. A sample that the gateway had not yet written down when
it was killed (0.25 s) or that was half read when its board was killed was never taken: those are counted apart, each beside its kill. Ends
with one line of JSON; exit status 0 where all of it holds, 77 where a server is not installed."""

import argparse
import json
import os
import random
import resource
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from services import Postgres, Service, broker, free_port, free_ports, programs_missing  # noqa: E402

BOARDS_A_PROCESS = 50
# A gateway writes down every 0.25 s what it has read; a loaded computer is late.
TAKEN_WITHIN_S = 2.0


def parse():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin")
    parser.add_argument("--boards", type=int, default=500)
    parser.add_argument("--gateways", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kills", type=int, default=40)
    parser.add_argument("--database", choices=["postgres", "sqlite"], default="postgres")
    parser.add_argument("--keep", help="folder for everything, kept; default: a temporary one")
    return parser.parse_args()


class Fleet:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        port = free_port()
        self.broker = broker(folder, port)
        self.postgres = Postgres(folder) if options.database == "postgres" else None
        self.registry = self.postgres.url if self.postgres else os.path.join(folder, "registry.db")
        vernier = os.path.join(options.bin, "vernier")
        self.ingest = Service("ingest", [vernier, "fleet", "ingest", "--registry", self.registry, "--broker", f"tcp://127.0.0.1:{port}"],
                              os.path.join(folder, "ingest.log"))
        self.first_port = free_ports(options.boards)
        self.journal = os.path.join(folder, "told")
        self.board_processes = []
        for first in range(0, options.boards, BOARDS_A_PROCESS):
            self.board_processes.append(Service(f"boards {first}", None, os.path.join(folder, f"boards{first}.log")))
            self.board_processes[-1].first = first
        self.gateways = []
        each = -(-options.boards // options.gateways)
        for number in range(options.gateways):
            path = os.path.join(folder, f"gateway{number}.toml")
            with open(path, "w") as file:
                file.write(f'[gateway]\nname = "gateway-{number}"\nbroker = "tcp://127.0.0.1:{port}"\nstore = "gateway{number}.db"\n')
                for board in range(number * each, min((number + 1) * each, options.boards)):
                    file.write(f'[[board]]\nmachine = "machine-{board}"\nboard = "board-{board}"\n'
                               f'url = "tcp://127.0.0.1:{self.first_port + board}"\n')
            self.gateways.append(Service(f"gateway {number}", [vernier, "fleet", "gateway", path],
                                         os.path.join(folder, f"gateway{number}.log")))
        self.each = each

    def start_boards(self, process):
        count = min(BOARDS_A_PROCESS, self.options.boards - process.first)
        boot = len(process.started_at)
        process.command = [os.path.join(self.options.bin, "fleet_boards"), str(process.first), str(count),
                           str(self.first_port + process.first), str(boot), self.journal + str(process.first)]
        process.start()

    def start(self, service):
        if service in self.board_processes:
            self.start_boards(service)
        else:
            service.start()

    def enter_machines(self):
        """Only samples of machines that are in the registry are stored."""
        for board in range(self.options.boards):
            subprocess.run([os.path.join(self.options.bin, "vernier"), "fleet", "add", f"machine-{board}", "--registry", self.registry], check=True)

    def start_all(self):
        if self.postgres:
            self.postgres.start()
            if not self.postgres.ready():
                raise RuntimeError("PostgreSQL does not come up")
            self.postgres.make_database()
        self.enter_machines()
        for one in [self.broker, self.ingest, *self.board_processes, *self.gateways]:
            self.start(one)

    def victims(self):
        """Kinds first, so that the one database dies as often as one of many gateways."""
        kinds = [[self.broker], [self.ingest], self.gateways, self.board_processes]
        return kinds + ([[self.postgres]] if self.postgres else [])

    def torment(self):
        """Kills from the seed: victim, moment, how long it stays away."""
        draw = random.Random(self.options.seed)
        begin = time.time()
        moments = sorted(draw.uniform(3, self.options.seconds) for _ in range(self.options.kills))
        to_start = []
        counts = {}
        for moment in [*moments, self.options.seconds]:
            while time.time() < begin + moment:
                self.start_due(to_start)
                time.sleep(0.02)
            if moment == self.options.seconds:
                break
            victim = draw.choice(draw.choice(self.victims()))
            away = draw.uniform(0.2, 4)
            if victim.process.poll() is not None:
                continue
            victim.kill()
            counts[victim.name.split()[0]] = counts.get(victim.name.split()[0], 0) + 1
            to_start.append((time.time() + away, victim))
        for _, victim in to_start:
            self.start(victim)
        return counts

    def start_due(self, to_start):
        for entry in [one for one in to_start if one[0] <= time.time()]:
            self.start(entry[1])
            to_start.remove(entry)

    def stores(self):
        rows = []
        for number in range(self.options.gateways):
            with sqlite3.connect(f"file:{self.folder}/gateway{number}.db?mode=ro", uri=True, timeout=20) as file:
                rows.append(file.execute("SELECT id, last, dropped, (SELECT COUNT(*) FROM record) FROM about").fetchone())
        return rows

    def run_dry(self, patience=240):
        """The boards end; then every store must empty itself."""
        for one in self.board_processes:
            one.kill()
        if self.postgres and not self.postgres.ready():
            return False
        time.sleep(1.5)
        end = time.time() + patience
        while time.time() < end:
            last = {row[0]: row[1] for row in self.stores()}
            stored = {row[0]: int(row[1]) for row in self.query("SELECT id, stored FROM spool")}
            if all(stored.get(key) == value for key, value in last.items()):
                return True
            time.sleep(0.3)
        return False

    def query(self, sql):
        if self.postgres:
            return self.postgres.query(sql)
        with sqlite3.connect(self.registry, timeout=20) as file:
            return [list(map(str, row)) for row in file.execute(sql).fetchall()]


def told(fleet):
    """(board, boot, tick) -> position and when, by the boards' journals; a line cut by a kill is none."""
    rows = {}
    for process in fleet.board_processes:
        with open(fleet.journal + str(process.first), "rb") as file:
            for line in file.read().split(b"\n")[:-1]:
                board, boot, tick, position, when = (int(word) for word in line.split())
                rows[(board, boot, tick)] = (position, when)
    return rows


def judge(fleet):
    names = {row[0]: {name: i for i, name in enumerate(json.loads(row[1]))} for row in fleet.query("SELECT id, names FROM shape")}
    was_told = told(fleet)
    stored, wrong, twice, values, historical = {}, [], 0, 0, 0
    sent_by = {row[0]: row[1] for row in fleet.query("SELECT id, gateway FROM spool")}
    for spool, _, machine, _, old, shape, text in fleet.query("SELECT * FROM sample"):
        row, at = json.loads(text), names[shape]
        values += len(row)
        historical += int(old)
        board = round((row[at["Inputs/T"]] - 20) * 1000)
        key = (board, round(row[at["Inputs/Boot"]]), row[at["Board/Tick"]])
        twice += key in stored
        stored[key] = machine
        if machine != f"machine-{board}" or sent_by[spool] != f"gateway-{board // fleet.each}":
            wrong.append(("another machine", key, machine, spool))
        elif key not in was_told or abs(was_told[key][0] * 1e-6 - row[at["Axes/X/Position"]]) > 1e-9:
            wrong.append(("another value", key, machine, row[at["Axes/X/Position"]], was_told.get(key)))
    lost, never_taken = [], 0
    for key, (_, when) in was_told.items():
        if key in stored:
            continue
        gateway = fleet.gateways[key[0] // fleet.each]
        process = fleet.board_processes[key[0] // BOARDS_A_PROCESS]
        moments = gateway.killed_at + process.killed_at
        if any(-0.1 <= moment - when / 1000 <= TAKEN_WITHIN_S for moment in moments):
            never_taken += 1
        else:
            lost.append((key, when))
    gaps = fleet.query("SELECT s.spool, COUNT(*), MAX(s.number), p.stored FROM sample s JOIN spool p ON p.id = s.spool "
                       "GROUP BY s.spool, p.stored")
    uneven = [row for row in gaps if not int(row[1]) == int(row[2]) == int(row[3])]
    live = sum(int(row[0]) for row in fleet.query("SELECT samples FROM live"))
    return {"told": len(was_told), "stored": len(stored), "values": values, "historical": historical, "twice": twice,
            "wrong": len(wrong), "lost": len(lost), "never_taken": never_taken, "stores_uneven": len(uneven),
            "given_up": int(fleet.query("SELECT COUNT(*) FROM loss")[0][0]), "counted_live": live, "examples": [*wrong[:3], *lost[:3], *uneven[:3]]}


def main():
    options = parse()
    missing = programs_missing(options.database)
    if missing:
        print(f"soak: Skipped\nnot installed: {' '.join(missing)}")
        return 77
    folder = options.keep or tempfile.mkdtemp(prefix="vernier_soak_")
    os.makedirs(folder, exist_ok=True)
    os.chmod(folder, 0o755)
    fleet = Fleet(options, folder)
    everything = [fleet.broker, fleet.ingest, *fleet.board_processes, *fleet.gateways, *([fleet.postgres] if fleet.postgres else [])]
    try:
        begin = time.time()
        fleet.start_all()
        kills = fleet.torment()
        for one in everything:
            if one.process.poll() is not None:
                print(f"soak: {one.name} ended by itself: {one.process.returncode}", file=sys.stderr)
        dry_from = time.time()
        dry = fleet.run_dry()
        answer = {"boards": options.boards, "gateways": options.gateways, "seconds": round(time.time() - begin, 1), "seed": options.seed,
                  "database": options.database, "kills": kills, "dry": dry, "dry_after_s": round(time.time() - dry_from, 1), **judge(fleet)}
        statuses = [one.end() for one in [*fleet.gateways, fleet.ingest]]
        answer["ended_well"] = all(status == 0 for status in statuses)
    finally:
        for one in everything:
            if one.process is not None and one.process.poll() is None:
                one.kill()
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    answer["cpu_s"] = round(usage.ru_utime + usage.ru_stime, 1)
    good = (dry and answer["ended_well"] and answer["stored"] > 0 and answer["counted_live"] == answer["stored"]
            and not any(answer[key] for key in ("twice", "wrong", "lost", "stores_uneven", "given_up")))
    answer["good"] = good
    print(json.dumps(answer))
    if not options.keep:
        shutil.rmtree(folder, ignore_errors=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
