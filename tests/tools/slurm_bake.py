#!/usr/bin/env python3
"""tools/slurm/bake.sh on a real Slurm of one node, started here: the field of one bake to the byte, also where the node died under the shards.

slurm_bake.py SCONCE BAKE.SH

Exits 77 where Slurm or munge isn't installed (Debian: slurmctld, slurmd, slurm-client, munge), 1 where a field differs or a job fails.
"""
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time

NEEDED = ["slurmctld", "slurmd", "sbatch", "scontrol", "squeue", "munged"]
POSITIONS = [(0, 1, 0), (0.5, 1.5, 0.3), (-0.5, 0.4, 0.6), (0.6, 0.5, -0.2), (-0.6, 1.6, -0.5), (0.1, 0.3, 0.7)]
BAKE = "--resolution 64 --surface-rays 4 --bounces 1 --surface-refined 0"
CONF = """ClusterName=sconce
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,bf_interval=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
KillWait=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def fail(sentence):
    print(f"slurm_bake.py: {sentence}", file=sys.stderr)
    sys.exit(1)


def free_ports(count):
    held = [socket.socket() for _ in range(count)]
    for one in held:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in held]
    for one in held:
        one.close()
    return ports


class Slurm:
    """A cluster of this machine alone, for as long as the object lives."""

    def __init__(self, folder):
        self.folder = folder
        self.host = socket.gethostname().split(".")[0]
        (folder / "state").mkdir()
        (folder / "spool").mkdir()
        (folder / "key").write_bytes(os.urandom(1024))
        (folder / "key").chmod(0o600)
        conf = folder / "slurm.conf"
        conf.write_text(CONF.format(host=self.host, ports=free_ports(2), folder=folder, cpus=os.cpu_count()))
        self.env = dict(os.environ, SLURM_CONF=str(conf))
        self.run("munged", "--force", *[f"--{what}={folder}/{name}" for what, name in (("key-file", "key"), ("socket", "munge.socket"), ("pid-file", "munged.pid"), ("log-file", "munged.log"), ("seed-file", "seed"))])
        self.run("slurmctld")
        self.run("slurmd")
        self.until("the node takes no jobs", lambda: "idle" in self.run("sinfo", "--noheader", "--format=%t"))

    def run(self, *command):
        done = subprocess.run(command, env=self.env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            fail(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    def until(self, trouble, true):
        for _ in range(1200):
            if true():
                return
            time.sleep(0.1)
        fail(f"{trouble}\n{self.run('squeue', '--array')}" + "".join((self.folder / f"{name}.log").read_text()[-2000:] for name in ("slurmctld", "slurmd")))

    def resumed(self):
        """Whether the node takes jobs again; it comes back by itself, too, where it answers before it is told to."""
        if "down" not in self.run("sinfo", "--noheader", "--format=%t"):
            return True
        subprocess.run(["scontrol", "update", f"nodename={self.host}", "state=resume"], env=self.env, check=False, stderr=subprocess.DEVNULL)
        return False

    def begin_what_waits(self):
        """Slurm lets minutes go by before a job whose node died begins again."""
        for job in self.run("squeue", "--noheader", "--array", "--states=PENDING", "--format=%i %j").splitlines():
            number, name = job.split()
            if name == "sconce-maps":
                self.run("scontrol", "update", f"jobid={number}", "starttime=now")

    def jobs(self, *of):
        return self.run("squeue", "--noheader", "--array", "--format=%j %T %r", *of).splitlines()

    def end(self):
        for name in ("slurmd", "slurmctld", "munged"):
            pid = self.folder / f"{name}.pid"
            if pid.exists():
                subprocess.run(["kill", pid.read_text().strip()], check=False)
        for _ in range(200): # they write to the folder until they have ended, and take their numbers away then
            if not any((self.folder / f"{name}.pid").exists() for name in ("slurmd", "slurmctld", "munged")):
                break
            time.sleep(0.1)


def main(sconce, script):
    missing = [name for name in NEEDED if not shutil.which(name)]
    if missing or os.geteuid() != 0:
        print(f"needs {', '.join(missing) or 'root'} for a Slurm of its own")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="sconce slurm ") as name: # a space: words of the jobs are quoted
        folder = pathlib.Path(name)
        probes = [{"position": position, "clearance": 0.1, "gain": 0} for position in POSITIONS]
        (folder / "probes.json").write_text(json.dumps({"scene": "cornell", "method": "sdf", "probes": probes}))
        (folder / "coarse.json").write_text(json.dumps({"quality": 1, "settings": {"octree voxels": 32}}))
        run = dict(cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        options = f"{BAKE} --quality coarse.json"
        whole = subprocess.run([sconce, "bake", "cornell", "--probes", "probes.json", *options.split(), "-o", "whole.sconce"], **run)
        if whole.returncode != 0:
            fail(whole.stdout)
        # munge takes no socket below a folder that others may write to, nor does Slurm a path with spaces.
        with tempfile.TemporaryDirectory(prefix="slurm", ignore_cleanup_errors=True) as place:
            slurm = Slurm(pathlib.Path(place))
            try:
                bake = lambda output, *more: subprocess.Popen([script, "cornell", "--shards", "3", "--bake", options, "-o", output, "--wait", *more],
                                                              env=dict(slurm.env, SCONCE=sconce), **run)
                ended = lambda job: (job.communicate()[0], job.returncode)
                text, code = ended(bake("field.sconce", "--probes", "probes.json"))
                logs = lambda: "".join(log.read_text() for log in folder.glob("*.parts/*.log"))
                if code != 0:
                    fail(f"exit {code}\n{text}{logs()}")
                if (folder / "field.sconce").read_bytes() != (folder / "whole.sconce").read_bytes():
                    fail("the field of shards is not that of one bake")
                if (folder / "field.sconce.parts").exists():
                    fail("the parts outlived the field that has all of them")

                job = bake("again.sconce", "--probes", "probes.json")
                slurm.until("no shard of the maps began", lambda: any(line.startswith("sconce-maps RUNNING") for line in slurm.jobs()))
                slurm.run("scontrol", "update", f"nodename={slurm.host}", "state=down", "reason=killed")
                slurm.until("the dead node's shards go on", lambda: not slurm.jobs("--states=RUNNING,COMPLETING"))
                slurm.until("the node stays dead", slurm.resumed)
                slurm.begin_what_waits()
                text, code = ended(job)
                if code != 0:
                    fail(f"after a node's death: exit {code}\n{text}{logs()}")
                if (folder / "again.sconce").read_bytes() != (folder / "whole.sconce").read_bytes():
                    fail("the field whose shards ran again is not that of one bake")

                text, code = ended(bake("placed.sconce", "--place", "--count 2"))
                placed = subprocess.run([sconce, "info", "placed.sconce", "--json"], **run)
                if code != 0 or json.loads(placed.stdout)["probes"] != 2:
                    fail(f"with placement: exit {code}\n{text}{placed.stdout}{logs()}")
                text, code = ended(bake("none.sconce", "--probes", "none.json"))
                if code == 0 or (folder / "none.sconce").exists() or "none.json" not in logs():
                    fail(f"without probes: exit {code}\n{text}{logs()}")
                shutil.copy(folder / "probes.json", folder / "none.json")
                text, code = ended(bake("none.sconce", "--probes", "none.json")) # what was said to help
                if code != 0 or (folder / "none.sconce").read_bytes() != (folder / "whole.sconce").read_bytes():
                    fail(f"the same command again: exit {code}\n{text}{logs()}")
            finally:
                slurm.end()
    print("fields of shards are those of one bake, after a node's death, too")


main(*sys.argv[1:])
