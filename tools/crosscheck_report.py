"""Tables and pictures of tools/crosscheck.py."""
import csv
import platform
import subprocess

import numpy as np


def write(options, results, pairs, povray, mitsuba_version):
    write_records(options.output / "records.csv", pairs)
    draw(options.output / "pictures.png", results, povray or [])
    text = [heading(options, mitsuba_version, results, povray), pair_table(pairs)]
    text.append(povray_table(povray) if povray is not None else "POV-Ray was not installed: left out.\n")
    (options.output / "tables.md").write_text("\n".join(text))


def write_records(file, pairs):
    with open(file, "w", newline="") as out:
        writer = csv.DictWriter(out, fieldnames=list(pairs[0]), lineterminator="\n")
        writer.writeheader()
        for pair in pairs:
            writer.writerow({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in pair.items()})


def first_line(*command):
    found = subprocess.run(command, capture_output=True, text=True)
    lines = [line for line in (found.stdout + found.stderr).splitlines() if "POV-Ray 3" in line or "causticbench" in line]
    return lines[0].strip() if lines else "?"


def heading(options, mitsuba_version, results, povray):
    cpu = sum(each["cpu_s"] for found, _ in results.values() for each in found.values())
    cpu += sum(row["cpu_s"] for row in povray or [])
    povray_version = first_line("povray", "--version") if povray is not None else "no POV-Ray"
    return (f"# Tables\n\nMade by `tools/crosscheck.py --seeds {options.seeds}`: "
            f"{first_line(str(options.bench), '--version')}, Mitsuba {mitsuba_version} (scalar_rgb), {povray_version}, "
            f"Python {platform.python_version()}, NumPy {np.__version__}; {cpu:.0f} CPU seconds.\n")


def pair_table(pairs):
    lines = ["| scene | estimate | against | ratio of the means | its standard error | cells | rms of z (expected) | largest \\|z\\| | its bound |",
             "|---|---|---|---|---|---|---|---|---|"]
    for p in pairs:
        lines.append(f"| {p['scene']} | {p['estimator']} | {p['reference']} | {p['ratio']:.4f} | {p['ratio_error']:.4f} "
                     f"| {p['cells']} | {p['z_rms']:.2f} ({p['expected_rms']:.2f}) | {p['z_max']:.2f} | {p['z_bound']:.2f} |")
    return "\n".join(lines) + "\n"


def povray_table(rows):
    lines = ["| scene | photons asked for | POV-Ray gathers photons in | ratio of the means to lighttrace | CPU s |", "|---|---|---|---|---|"]
    for row in rows:
        lines.append(f"| {row['scene']} | {row['count']} | {row['gathered']} | {row['ratio']:.4f} | {row['cpu_s']:.1f} |")
    return "\n".join(lines) + "\n"


def draw(file, results, povray):
    """One row a scene with caustics under a point light: ours, Mitsuba's, POV-Ray's, all exposed alike."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    scenes = [scene for scene in results if scene.endswith("_point") and "lighttrace" in results[scene][0]]
    if not scenes:
        return
    figure, axes = plt.subplots(len(scenes), 3, figsize=(7.2, 1.9 * len(scenes)), squeeze=False)
    for row, scene in zip(axes, scenes):
        found, mask = results[scene]
        pictures = [("lighttrace", found["lighttrace"]["picture"]), ("Mitsuba ptracer", found["ptracer"]["picture"])]
        pictures += [("POV-Ray", p["picture"]) for p in povray if p["scene"] == scene][:1]
        bright = np.quantile(found["lighttrace"]["picture"][mask], 0.99)
        for axis, (title, picture) in zip(row, pictures):
            axis.imshow(np.clip(np.where(mask[..., None], picture, 0.15 * bright) / bright, 0, 1) ** (1 / 2.2))
            axis.set_title(f"{scene}: {title}", fontsize=8)
        for axis in row:
            axis.set_axis_off()
    figure.tight_layout()
    figure.savefig(file, dpi=110)
