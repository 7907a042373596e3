"""Renderers as bench/peers drives them: each renders a picture and tells the CPU time it took.

`colour` is what a renderer's paths carry, "rgb" or "spectral"; freepath is compared with it in the
same.
"""

import glob
import json
import re
import subprocess
import sys
import venv
from pathlib import Path

from .measures import child_cpu_seconds

ROOT = Path(__file__).resolve().parents[2]


class Process:
    """A program that is started anew for each picture; its loading is part of the time."""

    def __init__(self, name, colour, version, command):
        self.name, self.colour, self.version, self.command = name, colour, version, command

    def render(self, spp, seed, picture):
        before = child_cpu_seconds()
        words = [str(word) for word in self.command(spp, seed, picture)]
        finished = subprocess.run(words, capture_output=True, text=True)
        if finished.returncode:
            sys.exit(f"peers: error: {' '.join(words)}:\n{finished.stderr.strip()[-800:]}")
        return child_cpu_seconds() - before

    def close(self):
        pass


class Worker:
    """A renderer that a process of its own keeps loaded (worker.py)."""

    colour = "rgb"

    def __init__(self, name, command, scene, log, environment=None):
        self.name, self.log = name, log
        words = [str(word) for word in command]
        with open(log, "w") as errors:
            self.process = subprocess.Popen(
                words,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=errors,
                text=True,
                env=environment,
            )
        self.version = self.ask(scene)["version"]

    def ask(self, request):
        try:
            self.process.stdin.write(json.dumps(request) + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # Below it says why.
        answer = self.process.stdout.readline()
        if not answer:
            said = Path(self.log).read_text().strip()
            sys.exit(
                f"peers: error: {self.name} ended: {said[-800:]}\nAll that it said is in {self.log}."
            )
        return json.loads(answer)

    def render(self, spp, seed, picture):
        return self.ask({"spp": spp, "seed": seed, "picture": str(picture)})["cpu"]

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def freepath(program, scene_file, colour, threads, options=()):
    version = subprocess.run(
        [program, "--version"], capture_output=True, text=True, check=True
    ).stdout.strip()
    name = "freepath" if colour == "rgb" else "freepath, spectral"
    return Process(
        name,
        colour,
        version,
        lambda spp, seed, picture: [
            program,
            "render",
            scene_file,
            "-o",
            picture,
            "--spp",
            spp,
            "--seed",
            seed,
            "--color",
            colour,
            "--threads",
            threads,
            "--progress",
            "none",
            *options,
        ],
    )


def pbrt(program, scene_file, threads):
    return Process(
        "pbrt",
        "spectral",
        f"pbrt-v4 at {program}",
        lambda spp, seed, picture: [
            program,
            "--quiet",
            "--nthreads",
            threads,
            "--spp",
            spp,
            "--seed",
            seed,
            "--outfile",
            picture,
            scene_file,
        ],
    )


def environment_of(package, folder):
    """The interpreter of a virtual environment in `folder` that has a package of PyPI, made if need be."""
    python = folder / "bin/python"
    if not (folder / "ready").exists():
        print(f"peers: getting {package} from PyPI into {folder}", file=sys.stderr)
        venv.create(folder, with_pip=True, clear=True)
        pip = [
            python,
            "-m",
            "pip",
            "install",
            "--quiet",
            "--disable-pip-version-check",
            package,
            "numpy",
        ]
        if subprocess.run([str(word) for word in pip]).returncode:
            sys.exit(
                f"peers: error: PyPI gave no {package} for Python {sys.version.split()[0]}. Is the network up? "
                f"Or leave it out: --peers"
            )
        (folder / "ready").touch()
    return python


def llvm_library():
    """A library of LLVM of at least 17: Dr.Jit takes 15 and 16 too, which cannot compile its kernels."""
    found = {}
    for path in glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob(
        "/usr/lib/llvm-*/lib/libLLVM*.so*"
    ):
        if version := re.search(r"libLLVM[-.](?:so\.)?(\d+)", path):
            found[int(version[1])] = path
    if max(found, default=0) < 17:
        sys.exit(
            "peers: error: Mitsuba's llvm variants need LLVM 17 or newer; install libllvm19, name a library in "
            "DRJIT_LIBLLVM_PATH, or take mitsuba-scalar"
        )
    return found[max(found)]


def mitsuba(variant, name, scene, threads, folder, environ):
    python = environment_of("mitsuba", folder / "mitsuba")
    if variant.startswith("llvm") and "DRJIT_LIBLLVM_PATH" not in environ:
        environ = environ | {"DRJIT_LIBLLVM_PATH": llvm_library()}
    command = [python, ROOT / "bench/peer_renderers/mitsuba_worker.py", variant, threads]
    return Worker(name, command, scene, folder / f"{name}.log", environ)


def cycles(scene, threads, folder):
    python = environment_of("bpy", folder / "blender")
    command = [python, ROOT / "bench/peer_renderers/cycles_worker.py", threads]
    return Worker("cycles", command, scene, folder / "cycles.log")
