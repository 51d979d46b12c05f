# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scenarios share. A scenario is LinuxCNC's DISPLAY: it runs while LinuxCNC does and ends it."""

import os
import subprocess
import sys
import threading
import time

import linuxcnc

passed, failed = [], []
vernier = os.environ["VERNIER"]
ticks_tool = os.environ["VERNIER_TICKS"]
command, stat, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()


def check(name, good, said=""):
    (passed if good else failed).append(name)
    print(("ok: " if good else "FAILED: ") + name + (f"  [{said}]" if said != "" else ""), flush=True)
    return good


def end():
    print(f"{len(passed)} passed, {len(failed)} failed", flush=True)
    sys.exit(0 if not failed else 1)


def halcmd(*words):
    result = subprocess.run(["halcmd", *words], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise RuntimeError(f"halcmd {' '.join(words)}: {result.stdout}{result.stderr}")
    return result.stdout.strip()


def pin(name):
    text = halcmd("getp", name)
    return {"TRUE": True, "FALSE": False}.get(text, None) if text in ("TRUE", "FALSE") else float(text)


def setp(name, value):
    halcmd("setp", name, str(value))


def enable(on):
    halcmd("sets", "enable", "1" if on else "0")


def until(what, patience=30.0):
    end_at = time.time() + patience
    while not what():
        if time.time() > end_at:
            return False
        time.sleep(0.01)
    return True


def poll():
    stat.poll()
    return stat


def said():
    """What LinuxCNC told its operator since the last call."""
    texts = []
    while (error := errors.poll()) is not None:
        texts.append(error[1])
    return texts


def state(wanted, number):
    command.state(wanted)
    return until(lambda: poll().task_state == number)


def power_on():
    state(linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ESTOP_RESET)
    return state(linuxcnc.STATE_ON, linuxcnc.STATE_ON)


def mode(wanted):
    command.mode(wanted)
    command.wait_complete(10)
    return until(lambda: poll().task_mode == wanted)


def home(joints):
    mode(linuxcnc.MODE_MANUAL)
    command.teleop_enable(0)
    command.wait_complete()
    # One after the other: a second order would end the first.
    for joint in joints:
        command.home(joint)
        command.wait_complete()
        until(lambda: poll().homed[joint] and not stat.joint[joint]["homing"])
    return all(poll().homed[j] for j in joints)


def idle():
    return until(lambda: poll().interp_state == linuxcnc.INTERP_IDLE and stat.inpos, 120)


def mdi(text):
    if poll().task_mode != linuxcnc.MODE_MDI:
        mode(linuxcnc.MODE_MDI)
    command.mdi(text)
    command.wait_complete(60)
    return idle()


def run_program(text, wait=True):
    with open("program.ngc", "w", encoding="ascii") as file:
        file.write(text)
    mode(linuxcnc.MODE_AUTO)
    command.program_open("program.ngc")
    command.wait_complete()
    command.auto(linuxcnc.AUTO_RUN, 0)
    until(lambda: poll().interp_state != linuxcnc.INTERP_IDLE, 5)
    return idle() if wait else True


def bring_in(patience=15):
    enable(True)
    return until(lambda: pin("vernier.0.active"), patience)


def take_out():
    enable(False)
    joints = range(len(active_joints()))
    return until(lambda: all(pin(f"vernier.0.joint.{j}.correction") == 0 for j in joints), 15)


def active_joints():
    return range(poll().joints)


class Recording:
    """Every tick of the servo thread while it lasts: rows of numbers, as the sampler's pins stand in machine.hal."""

    def __init__(self):
        self.rows, self.lost = [], 0
        setp("sampler.0.enable", 1)
        self.process = subprocess.Popen(["halsampler", "-t"], stdout=subprocess.PIPE, text=True)
        self.reader = threading.Thread(target=self.read)
        self.reader.start()

    def read(self):
        last = None
        for line in self.process.stdout:
            words = line.split()
            if words[0] == "overrun":
                continue
            number = int(words[0])
            # What an earlier recording left behind is not of this one.
            if last is not None and number != last + 1:
                self.lost += 1
            last = number
            self.rows.append([float(word) for word in words[1:]])

    def end(self):
        setp("sampler.0.enable", 0)
        time.sleep(0.3)
        self.process.terminate()
        self.process.wait()
        self.reader.join()
        return self.rows


def column(rows, index):
    return [row[index] for row in rows]


def largest_step(rows, index, base=None):
    """Of a column from tick to tick, beside that of `base` where one is given: the drive's beyond the command's."""
    most = 0.0
    for before, after in zip(rows, rows[1:]):
        step = after[index] - before[index]
        if base is not None:
            step -= after[base] - before[base]
        most = max(most, abs(step))
    return most


def rms(values):
    return (sum(v * v for v in values) / len(values)) ** 0.5 if values else float("nan")


def tool(*words, **options):
    return subprocess.run([vernier, *words], capture_output=True, text=True, check=False, **options)
