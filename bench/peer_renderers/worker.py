"""The loop of a renderer that stays in memory: requests on standard input, answers on output."""

import json
import os
import sys
import time


def serve(load, compiles=True):
    """Answers lines of JSON with one line each.

    The first request is a scene, of which `load` makes a function of spp and seed that renders and
    returns what else has to be called, untimed, with the path of the PFM file. The answer to it is
    what describes the renderer. The others are {"spp", "seed", "picture"}; their answer is the CPU
    time of the process, all threads, for rendering. What `compiles` renders a first picture of each
    sample count untimed.
    """
    # What libraries print goes to the log, not between the answers.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)

    def answer(value):
        answers.write(json.dumps(value) + "\n")
        answers.flush()

    version, render = load(json.loads(sys.stdin.readline()))
    answer({"version": version})
    warm = set()
    for line in sys.stdin:
        request = json.loads(line)
        if compiles and request["spp"] not in warm:
            render(request["spp"], 0)
            warm.add(request["spp"])
        before = time.process_time()
        write = render(request["spp"], request["seed"])
        seconds = time.process_time() - before
        write(request["picture"])
        answer({"cpu": seconds})


def write_pfm(path, rows):
    """Writes a numpy array of rows from below, of columns, of R, G, B."""
    height, width, _ = rows.shape
    with open(path, "wb") as file:
        file.write(f"PF\n{width} {height}\n-1.0\n".encode())
        file.write(rows.astype("<f4").tobytes())
