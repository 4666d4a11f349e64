#!/usr/bin/env python3
"""A bake that is killed at random moments, and started again by the same command, ends with the file of one that nobody disturbed.

kill_bakes.py SCONCE

The environment's SCONCE_KILLS says how often (default: as a test of the suite has time for; 2000 to soak), SCONCE_SEED which moments. Exits 1
where a file differs, is half-written, or a start after a kill fails.
"""
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

KILLS = 8
POSITIONS = [(0, 1, 0), (0.5, 1.5, 0.3), (-0.5, 0.4, 0.6), (0.6, 0.5, -0.2), (-0.6, 1.6, -0.5), (0.1, 0.3, 0.7)]


def fail(sentence):
    print(f"kill_bakes.py: {sentence}", file=sys.stderr)
    sys.exit(1)


class Bakes:
    def __init__(self, sconce, folder):
        self.folder = folder
        self.output = folder / "f.sconce"
        self.journal = folder / ".f.sconce.journal"
        probes = [{"position": position, "clearance": 0.1, "gain": 0} for position in POSITIONS]
        (folder / "probes.json").write_text(json.dumps({"scene": "cornell", "method": "sdf", "probes": probes}))
        (folder / "coarse.json").write_text(json.dumps({"quality": 1, "settings": {"octree voxels": 32}}))
        self.command = [sconce, "bake", "cornell", "--probes", folder / "probes.json", "--quality", folder / "coarse.json", "--resolution", "64",
                        "--surface-rays", "4", "--bounces", "1", "--surface-refined", "0", "-o", self.output]

    def start(self):
        return subprocess.Popen(self.command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def finish(self, process):
        _, err = process.communicate()
        if process.returncode != 0:
            fail(f"exit {process.returncode}\n{err}")
        if self.journal.exists():
            fail("the journal outlived the file that has all of it")
        return self.output.read_bytes()

    def killed_after(self, seconds):
        """Whether the bake lived so long; else it has ended, and its bytes."""
        process = self.start()
        try:
            process.wait(seconds)
            return self.finish(process)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return None


def main(sconce):
    wanted = int(os.environ.get("SCONCE_KILLS", KILLS))
    seed = int(os.environ.get("SCONCE_SEED", 1))
    moments = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        bakes = Bakes(sconce, pathlib.Path(folder))
        began = time.monotonic()
        whole = bakes.finish(bakes.start())
        seconds = time.monotonic() - began
        kills = rounds = went_on = 0
        while kills < wanted:
            rounds += 1
            bakes.output.unlink()
            ended = None
            while ended is None and kills < wanted:
                ended = bakes.killed_after(moments.uniform(0, 1.1 * seconds))
                if ended is None:
                    kills += 1
                    went_on += bakes.journal.exists() and bakes.journal.stat().st_size > 100_000
                    if bakes.output.exists() and bakes.output.read_bytes() != whole:
                        fail(f"kill {kills} of seed {seed} left half a file")
            if (ended or bakes.finish(bakes.start())) != whole:
                fail(f"after kill {kills} of seed {seed}, the file is not that of an undisturbed bake")
        if kills >= KILLS and went_on == 0:
            fail(f"none of {kills} kills left a journal to go on from: the test tests nothing")
        print(f"{kills} kills of {rounds} bakes, {went_on} with finished parts in the journal; every file is the undisturbed one")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    main(sys.argv[1])
