#!/usr/bin/env python3
"""What pictures say of the light that their caustic lacks or has too much, beside what it is.

Usage: told_losses.py PROGRAM CASE...     a file `causticbench`; a case is SCENE:METHOD[:KEY=VALUE]...

Prints a Markdown table: for each case the caustic's light over that of `lighttrace` (16 million paths of 1,000 events, in pixels that it
reaches), and the notes on light that `render` prints.
"""

import os
import re
import subprocess
import sys
import tempfile

from mean_ratio import mean_ratio

PATHS = 16_000_000
FILM = ("--set", "/sensor/film/width=64", "--set", "/sensor/film/height=48", "--spp", "16")
TELLING = re.compile(r"(loses [\d.]+ % of the caustic|cuts [\d.]+ % of the caustic|beams with [\d.]+ % of the light on casters: photons carry|"
                     r"has [\d.]+ ± [\d.]+ of the light)")


def render(program, scene, method, params, picture):
    """The notes."""
    command = [program, "render", scene, "--method", method, "-o", picture, *FILM]
    done = subprocess.run(command + [word for param in params for word in ("--param", param)], check=True, capture_output=True, text=True)
    return [match[1] for line in (done.stdout + done.stderr).splitlines() if line.startswith("note:") and (match := TELLING.search(line))]


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    program, *cases = sys.argv[1:]
    print("| scene | method and parameters | light over `lighttrace`'s | what is told |\n|---|---|--:|---|")
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "picture.exr")
        references = {}
        for case in cases:
            scene, method, *params = case.split(":")
            if scene not in references:
                references[scene] = os.path.join(folder, f"reference{len(references)}.exr")
                render(program, scene, "lighttrace", [f"paths={PATHS}"], references[scene])
            told = render(program, scene, method, params, picture)
            ratio = mean_ratio(program, picture, references[scene])
            name = os.path.splitext(os.path.basename(scene))[0]
            print(f"| {name} | {method} {' '.join(params)} | {ratio:.4f} | {'; '.join(told) or 'nothing'} |", flush=True)


if __name__ == "__main__":
    main()
