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
    lines = ["| scene | estimate | against | ratio of the means | ± | without the direct light | ± | cells | mean z² (expected) | \\|z\\| > 3 (expected) "
             "| p of the z² | largest \\|z\\| | its p |", "|" + "---|" * 13]
    for p in pairs:
        # Without a caustic they are the same.
        caustic = f"{p['caustic_ratio']:.4f} | {p['caustic_error']:.4f}" if p["reference"] == "lighttrace" else "– | –"
        lines.append(f"| {p['scene']} | {p['estimator']} | {p['reference']} | {p['ratio']:.4f} | {p['ratio_error']:.4f} | {caustic} "
                     f"| {p['cells']} | {p['z2_mean']:.2f} ({p['z2_expected']:.2f}) "
                     f"| {p['above_3']} ({p['above_3_expected']:.2f}) | {p['p_squares']:.2g} "
                     f"| {p['z_largest']:.2f} | {p['p_largest']:.2g} |")
    return "\n".join(lines) + "\n\n" + summary(pairs)


def summary(pairs):
    pairs = [p for p in pairs if p["estimator"] != "globalphotonmap"]  # a biased one
    scores = [abs(p["ratio"] - 1) / p["ratio_error"] for p in pairs]
    smallest = min(min(p["p_squares"], p["p_largest"]) for p in pairs)
    return (f"Of {len(pairs)} ratios the farthest is {max(abs(p['ratio'] - 1) for p in pairs):.4f} from 1, and "
            f"{max(scores):.1f} of its standard errors is the farthest. Of {sum(p['cells'] for p in pairs)} cells "
            f"{sum(p['above_3'] for p in pairs)} have a |z| above 3, where chance alone gives "
            f"{sum(p['above_3_expected'] for p in pairs):.1f}. The smallest of the {2 * len(pairs)} p-values is "
            f"{smallest:.2g}, {min(1.0, 2 * len(pairs) * smallest):.2g} after Bonferroni's correction.\n")


def povray_table(rows):
    lines = ["| scene | photons asked for | POV-Ray gathers photons in | ratio of the means to lighttrace "
             "| of the caustics alone | CPU s |", "|" + "---|" * 6]
    for row in rows:
        lines.append(f"| {row['scene']} | {row['count']} | {row['gathered']} | {row['ratio']:.4f} "
                     f"| {row['caustic_ratio']:.4f} | {row['cpu_s']:.1f} |")
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
