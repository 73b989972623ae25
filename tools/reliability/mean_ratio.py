"""The light of one picture over another's, as `causticbench compare` says it."""

import json
import subprocess


def mean_ratio(program, picture, reference):
    """Mean of the caustic over the reference's, in the pixels that the reference reaches."""
    result = subprocess.run([program, "compare", picture, reference, "--json"], check=True, capture_output=True, text=True)
    return json.loads(result.stdout)["metrics"]["mean_ratio"]
