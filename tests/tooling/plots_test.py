"""tools/plot_records.py from outside: medians by hand, same bytes twice, and every broken table named in one line."""
import csv
import html
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import urllib.parse
import xml.etree.ElementTree

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "plot_records.py"
FIXED = ("trial,status,scene,method,seed,repeat,threads,isa,photons_emitted,photons_stored,nearest,alpha,"
         "mesh_resolution,polygons,beams,cone_point_tests,beam_point_tests,beam_point_hits,map_bytes,rss_start_bytes,"
         "peak_rss_bytes,parse_s,precompute_s,balance_s,render_s,total_s,cpu_s,rmse,relmse,bias,variance,mean_ratio,"
         "leak_energy,beauty_rmse,unreached_fraction,reference,reference_stderr,config_hash,code_version").split(",")
ALL_PLOTS = {"rmse_vs_photons", "rmse_vs_time", "rmse_vs_alpha", "relmse_vs_alpha", "rmse_vs_mesh_resolution",
             "mean_ratio_vs_mesh_resolution"}


def record(**values):
    """One done trial; the errors fall with photons and differ by seed."""
    row = {"status": "done", "scene": "pool", "method": "photonmap", "seed": 1, "repeat": 0, "threads": 1,
           "isa": "avx2", "photons": 1000, "nearest": 25, "alpha": 1, "mesh_resolution": 32, "total_s": 0.5,
           "precompute_s": 0.2, "render_s": 0.3, "mean_ratio": 0.98, "reference_stderr": 0.001, "code_version": "abc"}
    row.update(values)
    row.setdefault("photons_stored", row["photons"])
    row.setdefault("rmse", 0.1 * row["seed"] * 1000 / (row["photons_stored"] or 1000))
    row.setdefault("relmse", 0.5)
    named = ("scene", "method", "photons", "photons_stored", "nearest", "alpha", "mesh_resolution", "seed", "repeat")
    row.setdefault("trial", "-".join(str(row[name]) for name in named))
    return row


def product(seeds=(1, 2, 3), photons=(1000, 10000), nearest=(25, 50), alpha=(0.1, 1), mesh=(32, 64)):
    return [record(seed=s, photons=p, nearest=n, alpha=a, mesh_resolution=m, total_s=p * 1e-4 + n * 1e-2)
            for p in photons for n in nearest for a in alpha for m in mesh for s in seeds]


class Columns(unittest.TestCase):
    def test_no_column_of_every_trial_is_taken_for_a_swept_parameter(self):
        text = (TOOL.parents[1] / "experiments" / "plan" / "record_columns.cpp").read_text(encoding="utf-8")
        names = re.findall(r'^    \{"(\w+)", "/', text, re.MULTILINE)
        sys.path.insert(0, str(TOOL.parent))
        from report import records
        self.assertIn("code_version", names)
        after = names[names.index("code_version") + 1:]
        self.assertEqual([name for name in after if name not in records.NOT_SWEPT], [])
        numbers = re.findall(r'^    \{"(\w+)", "[^"]*", Kind::(?:number|count)', text, re.MULTILINE)
        self.assertGreater(len(numbers), 60)
        self.assertEqual([name for name in numbers if name not in records.NUMBERS], [], "which no tool checks")


class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.font_cache = tempfile.TemporaryDirectory()  # one for all: filling it takes longer than any plot

    @classmethod
    def tearDownClass(cls):
        cls.font_cache.cleanup()

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.directory = pathlib.Path(self.folder.name)
        self.report = self.directory / "report"

    def tearDown(self):
        self.folder.cleanup()

    def table(self, rows, header=(*FIXED, "photons")):
        with open(self.directory / "records.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, header, restval="", extrasaction="ignore")
            writer.writeheader()
            writer.writerows(rows)

    def run_tool(self, *arguments):
        environment = {**os.environ, "MPLCONFIGDIR": self.font_cache.name}
        return subprocess.run([sys.executable, str(TOOL), str(self.directory), *arguments], env=environment,
                              capture_output=True, text=True, encoding="utf-8", check=False)

    def succeeds(self):
        result = self.run_tool()
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def refuses(self, *words):
        result = self.run_tool()
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for word in ("records.csv", *words):
            self.assertIn(word, result.stderr)
        self.assertFalse(self.report.exists())

    def plots(self):
        return {path.name for path in (self.report / "plots").iterdir()}

    def summary(self):
        with open(self.report / "summary.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def bytes_of_report(self):
        return {str(path.relative_to(self.report)): path.read_bytes()
                for path in sorted(self.report.rglob("*")) if path.is_file()}

    def test_a_full_product_has_every_plot_and_the_same_bytes_twice(self):
        self.table(product())
        output = self.succeeds()
        self.assertEqual(self.plots(), {f"{name}-pool.svg" for name in ALL_PLOTS} | {"mean_ratio.svg"})
        self.assertIn("left out: none", output)
        for path in (self.report / "plots").iterdir():
            xml.etree.ElementTree.parse(path)
        first = self.bytes_of_report()
        self.assertTrue({"index.html", "summary.csv", "summary.md", "summary.tex"} <= set(first))
        self.succeeds()
        self.assertEqual(first, self.bytes_of_report())

    def test_the_summary_has_medians_and_ranges_by_hand(self):
        errors = {1: 0.3, 2: 0.1, 3: 0.25, 4: 0.2}
        self.table([record(seed=s, rmse=e, relmse=2 * e, mean_ratio=1 + e, total_s=10 * e)
                    for s, e in errors.items()] + [record(photons=5000, rmse=0.05)])
        self.succeeds()
        several, single = self.summary()
        self.assertEqual((several["photons"], several["records"], several["seeds"]), ("1000", "4", "4"))
        for name, middle, low, high in (("rmse", 0.225, 0.1, 0.3), ("relmse", 0.45, 0.2, 0.6),
                                        ("mean_ratio", 1.225, 1.1, 1.3), ("total_s", 2.25, 1, 3)):
            for what, value in (("median", middle), ("min", low), ("max", high)):
                self.assertAlmostEqual(float(several[f"{name}_{what}"]), value, places=12)
        self.assertEqual([single[f"rmse_{what}"] for what in ("median", "min", "max")], ["0.05"] * 3)
        markdown = (self.report / "summary.md").read_text(encoding="utf-8")
        self.assertIn("| 0.225 [0.1, 0.3] |", markdown)
        self.assertIn("ε = 0.01 mean(r)²", markdown)

    def test_repeats_join_the_cell_of_their_seeds(self):
        self.table([record(seed=s, repeat=r, total_s=t) for s, r, t in ((1, 0, 1), (1, 1, 2), (2, 0, 6), (2, 1, 7))])
        self.succeeds()
        cell, = self.summary()
        self.assertEqual((cell["records"], cell["seeds"], cell["total_s_median"]), ("4", "2", "4.0"))

    def test_two_spellings_of_a_number_are_one_cell(self):
        self.table([record(seed=1, alpha="0.10", photons_stored=1000, photons="1e3"), record(seed=2, alpha="0.1")])
        self.succeeds()
        self.assertEqual(len(self.summary()), 1)

    def test_other_fixed_columns_are_no_parameters(self):
        header = (*FIXED, "mask_rmse", "render_cpu_s", "spp", "message", "reference_mean", "photons")
        self.table([record(seed=s, mask_rmse=s, render_cpu_s=s, message=f"line\n{s}", spp=4, reference_mean=0.5)
                    for s in (1, 2)], header)
        self.succeeds()
        cell, = self.summary()
        self.assertEqual((cell["seeds"], cell["spp"]), ("2", "4"))
        self.assertNotIn("message", cell)

    def test_the_reference_error_is_drawn_where_its_scale_is_known(self):
        rows = [record(photons=p, reference_mean=0.5) for p in (1000, 10000)]
        self.table(rows)
        self.succeeds()
        name = self.report / "plots" / "rmse_vs_photons-pool.svg"
        without = name.read_text(encoding="utf-8")
        self.table(rows, (*FIXED, "reference_mean", "photons"))
        self.succeeds()
        self.assertEqual(without.count("stroke-dasharray"), 0)
        self.assertEqual(name.read_text(encoding="utf-8").count("stroke-dasharray"), 2)  # the line and its legend

    def test_one_seed_is_enough(self):
        self.table([record(photons=p, mesh_resolution="") for p in (1000, 10000)])
        output = self.succeeds()
        self.assertEqual(self.plots(), {"rmse_vs_photons-pool.svg", "mean_ratio.svg"})
        self.assertIn("rmse_vs_time (fewer than two values of time)", output)
        self.assertIn("rmse_vs_mesh_resolution (no row has mesh_resolution and rmse)", output)
        self.assertIn("relmse_vs_alpha (fewer than two values of alpha)", output)

    def test_trials_that_are_not_done_are_counted_and_left_out(self):
        self.table(product(alpha=(1,), mesh=("",)) + [record(seed=9, status="failed", rmse="nan"),
                                                      record(seed=9, status="timeout", rmse="", total_s="")])
        self.assertIn("12 done; left out of the plots: 1 failed, 1 timeout", self.succeeds())
        self.assertTrue(all(cell["seeds"] == "3" for cell in self.summary()))

    def test_empty_fields_do_not_apply(self):
        rows = product(alpha=(0.1, 1), mesh=("",), nearest=(25,))
        rows += [record(scene="ring", alpha="", mesh_resolution="", seed=s, photons=p, rmse="", relmse="",
                        mean_ratio="") for s in (1, 2) for p in (1000, 10000)]
        rows += [record(method="none", nearest="", photons="", photons_stored="", alpha=a, mesh_resolution="",
                        reference_stderr="", rmse=1, mean_ratio=0) for a in (0.1, 1)]
        self.table(rows)
        output = self.succeeds()
        self.assertEqual({name for name in self.plots() if "ring" in name}, set())
        self.assertIn("rmse_vs_photons of ring (no row has stored photons and rmse)", output)
        ring = [cell for cell in self.summary() if cell["scene"] == "ring"]
        self.assertEqual([cell["rmse_median"] for cell in ring], ["", ""])

    def labels(self, name):
        """The words of a figure; those of SVG are outlines, named by their letters."""
        text = (self.report / "plots" / name).read_text(encoding="utf-8")
        return {html.unescape(words) for words in re.findall(r"<!-- (.*?) -->", text)}

    def compare_methods(self):
        header = (*FIXED, "photons", "render_cpu_s", "intensity", "paths")
        beams = dict(method="beamtree", photons="", nearest="", photons_stored="")
        rows = [record(seed=s, photons=p, mesh_resolution="", render_cpu_s=p * 1e-4) for p in (1000, 10000) for s in (1, 2)]
        rows += [record(seed=s, mesh_resolution=m, intensity="area", rmse=0.1 / m, render_cpu_s=m, trial=f"b{m}-{s}", **beams)
                 for m in (16, 64) for s in (1, 2)]
        rows += [record(seed=s, method="lighttrace", photons="", nearest="", mesh_resolution="", paths=p, photons_stored=p, render_cpu_s=1,
                        trial=f"l{p}-{s}") for p in (1000, 5000) for s in (1, 2)]
        self.table(rows, header)

    def test_lines_run_along_meshes_and_paths(self):
        self.compare_methods()
        self.succeeds()
        self.assertIn("rmse_vs_mesh_resolution-pool.svg", self.plots())
        found = self.labels("rmse_vs_time-pool.svg")
        self.assertLessEqual({"beamtree", "lighttrace", "photonmap, N = 25", "CPU time of build and query [s]"}, found)
        self.assertEqual([words for words in found if "mesh_resolution" in words or "paths" in words or "intensity" in words], [])

    def test_methods_without_photons_are_levels(self):
        self.compare_methods()
        self.succeeds()
        self.assertIn("beamtree (mesh_resolution 64, no photons)", self.labels("rmse_vs_photons-pool.svg"))

    def test_times_are_wall_where_cpu_is_not_recorded(self):
        self.table(product())
        self.succeeds()
        self.assertIn("wall time of the whole trial [s]", self.labels("rmse_vs_time-pool.svg"))

    def test_a_figure_is_what_is_asked_for(self):
        self.table(product())
        out = self.directory / "figures"
        for form, start in (("svg", b"<?xml"), ("pdf", b"%PDF"), ("png", b"\x89PNG")):
            result = self.run_tool("-o", str(out / form), "--metric", "relmse", "--x", "alpha", "--format", form, "--bare", "--slope", "-0.5",
                                   "--filter", "nearest=25", "--filter", "photons=1e3", "--filter", "mesh_resolution=32.0", "--width", "5")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual([path.name for path in (out / form / "plots").iterdir()], [f"relmse_vs_alpha-pool.{form}"])
            content = (out / form / "plots" / f"relmse_vs_alpha-pool.{form}").read_bytes()
            self.assertEqual(content[:len(start)], start)
        text = (out / "svg" / "plots" / "relmse_vs_alpha-pool.svg").read_text(encoding="utf-8")
        self.assertIn('width="360pt"', text)
        self.assertIn("slope −0.5", text)
        self.assertNotIn("median and range", text)
        with open(out / "svg" / "summary.csv", newline="", encoding="utf-8") as file:
            self.assertEqual({(row["nearest"], row["photons"], row["mesh_resolution"]) for row in csv.DictReader(file)}, {("25", "1000", "32")})

    def test_intervals_are_students_of_the_mean_over_the_seeds(self):
        sys.path.insert(0, str(TOOL.parent))
        from report import records
        # Repeats of a seed make the same picture again: three values, not four.
        cell = records.Cell("pool", "photonmap", {}, [{"seed": seed, "rmse": rmse} for seed, rmse in
                                                      (("1", "1"), ("2", "2"), ("2", "2"), ("3", "6"))])
        spread = cell.mean("rmse")
        reach = 4.302652730 * math.sqrt(7 / 3)  # of two degrees of freedom; the variance of 1, 2, 6 is 7
        for value, wanted in ((spread.median, 3), (spread.low, 3 - reach), (spread.high, 3 + reach)):
            self.assertAlmostEqual(value, wanted, places=6)
        self.assertIsNone(cell.mean("relmse"))
        self.table(product())
        out = self.directory / "figures"
        result = self.run_tool("-o", str(out), "--metric", "rmse", "--x", "photons", "--interval")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("mean and its 95 % interval over 3 seeds", (out / "index.html").read_text(encoding="utf-8"))

    def test_figures_that_cannot_be_are_refused(self):
        self.table(product())
        for words, reason in ((("--metric", "speed"), "--metric speed: no number of the table (known: "),
                              (("--x", "colour"), "--x colour: not time, photons or a swept number (alpha, "),
                              (("--filter", "nearest"), "not a KEY=VALUE"), (("--filter", "nearest=7"), "no record that is done has it")):
            result = self.run_tool("-o", str(self.directory / "out"), *words)
            self.assertEqual((result.returncode, len(result.stderr.splitlines())), (2, 1), result.stderr)
            self.assertIn(reason, result.stderr)
        self.assertIn("need -o", self.run_tool("--metric", "rmse").stderr)
        for text in ("nan", "inf", "-inf", "1e308", "steep"):
            result = self.run_tool("-o", str(self.directory / "out"), f"--slope={text}")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("--slope: ", result.stderr)
            self.assertNotIn("Traceback", result.stderr)

    def test_values_that_vary_only_together_make_no_series(self):
        self.table([record(alpha=a, mesh_resolution=m, seed=s) for a, m in ((0.1, 32), (1, 64)) for s in (1, 2)])
        output = self.succeeds()
        self.assertIn("rmse_vs_alpha (no two values of alpha with all else equal)", output)

    def test_stored_photons_tell_cells_apart_only_where_seeds_repeat(self):
        rows = [record(seed=s, photons_stored=p) for p in (1000, 2000) for s in (1, 2)]
        self.table(rows, FIXED)
        self.succeeds()
        self.assertEqual([cell["photons_stored"] for cell in self.summary()], ["1000", "2000"])
        self.table([record(seed=s, photons_stored=1000 + s) for s in (1, 2, 3)], FIXED)
        self.succeeds()
        cell, = self.summary()
        self.assertEqual((cell["seeds"], cell["photons_stored_median"]), ("3", "1002.0"))

    def test_the_page_shows_plots_figures_and_the_table_without_scripts(self):
        figures = self.report / "figures" / "pool water"
        figures.mkdir(parents=True)
        (figures / "strip.png").write_bytes(b"not read")
        stale = self.report / "plots" / "rmse_vs_alpha-gone.svg"
        stale.parent.mkdir()
        stale.write_text("stale")
        self.table([record(scene="a/b <c>", photons=p) for p in (1000, 10000)])
        self.succeeds()
        self.assertFalse(stale.exists())
        page = (self.report / "index.html").read_text(encoding="utf-8")
        self.assertIn('src="figures/pool%20water/strip.png"', page)
        self.assertNotIn("<script", page)
        self.assertIn("<td>a/b &lt;c&gt;</td>", page)
        links = re.findall(r'(?:src|href)="([^"]*)"', page)
        self.assertIn("plots/rmse_vs_photons-a%252Fb%2520%253Cc%253E.svg", links)
        for link in links:
            self.assertTrue((self.report / urllib.parse.unquote(link)).is_file(), link)

    def test_another_output_folder_still_finds_the_figures(self):
        (self.report / "figures").mkdir(parents=True)
        (self.report / "figures" / "strip.png").write_bytes(b"not read")
        self.table([record()])
        result = self.run_tool("-o", str(self.directory / "elsewhere" / "deep"))
        self.assertEqual(result.returncode, 0, result.stderr)
        page = (self.directory / "elsewhere" / "deep" / "index.html").read_text(encoding="utf-8")
        self.assertIn('src="../../report/figures/strip.png"', page)

    def test_names_are_no_formulas_of_matplotlib(self):
        self.table([record(scene=r"a$\x$b", photons=p) for p in (1000, 10000)])
        self.succeeds()

    def test_links_do_not_lead_out_of_the_folder(self):
        elsewhere = self.directory / "elsewhere"
        elsewhere.mkdir()
        (elsewhere / "file").write_text("precious")
        self.table(product())
        for name in ("report", "report/plots"):
            place = self.directory / name
            place.parent.mkdir(exist_ok=True)
            place.symlink_to(elsewhere)
            result = self.run_tool()
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"{name}: is a symbolic link", result.stderr)
            place.unlink()
        (self.report / "index.html.part").symlink_to(elsewhere / "file")
        self.succeeds()
        self.assertEqual([path.name for path in elsewhere.iterdir()], ["file"])
        self.assertEqual((elsewhere / "file").read_text(), "precious")

    def test_latex_escapes_names(self):
        self.table([record(scene="pool_50%", seed=s) for s in (1, 2)])
        self.succeeds()
        text = (self.report / "summary.tex").read_text(encoding="utf-8")
        self.assertIn(r"pool\_50\%", text)
        self.assertIn(r"\varepsilon=0.01\,\mathrm{mean}(r)^2", text)
        rows = [line for line in text.splitlines() if "&" in line]
        self.assertEqual(len({row.count(" & ") for row in rows}), 1)

    def test_markdown_and_html_show_the_html_of_names(self):
        self.table([record(scene="<img src=x onerror=alert(1)>&|", seed=s) for s in (1, 2)])
        self.succeeds()
        for name in ("summary.md", "index.html"):
            text = (self.report / name).read_text(encoding="utf-8")
            self.assertNotIn("<img src=x", text, name)
            self.assertIn("&lt;img src=x onerror=alert(1)&gt;&amp;", text, name)
        self.assertIn(r"&amp;\| |", (self.report / "summary.md").read_text(encoding="utf-8"))

    def test_what_is_the_same_in_all_rows_has_no_column(self):
        header = (*FIXED, "photons", "height", "filter_k")
        self.table([record(seed=s, photons=n, height=96) for s in (1, 2) for n in (1000, 2000)], header)
        self.succeeds()
        latex = (self.report / "summary.tex").read_text(encoding="utf-8")
        rows = [line for line in latex.splitlines() if "&" in line]
        self.assertTrue(rows[0].startswith(r"scene & method & photons & seeds & rmse"), rows[0])
        shared = "In all rows: nearest 25, alpha 1, mesh{0}_resolution 32, height 96, threads 1, isa avx2, code{0}_version abc."
        self.assertIn(shared.format("\\") + "}", latex)
        markdown = (self.report / "summary.md").read_text(encoding="utf-8")
        self.assertIn("| scene | method | photons | seeds |", markdown)
        self.assertIn(shared.format("") + "\n", markdown)
        page = (self.report / "index.html").read_text(encoding="utf-8")
        self.assertIn(shared.format("") + "</caption>", page)
        self.assertEqual({cell["height"] for cell in self.summary()}, {"96"}, "summary.csv keeps every column")

    def test_a_missing_table(self):
        self.refuses("No such file")

    def test_an_empty_table(self):
        (self.directory / "records.csv").write_text("")
        self.refuses("empty")

    def test_a_header_without_rows(self):
        self.table([])
        self.refuses("without rows")

    def test_missing_columns(self):
        self.table(product(), [name for name in FIXED if name not in ("rmse", "nearest")])
        self.refuses("missing columns rmse, nearest")

    def test_a_column_twice(self):
        self.table(product(), (*FIXED, "alpha"))
        self.refuses("column alpha is there twice")

    def test_a_torn_row(self):
        self.table(product())
        path = self.directory / "records.csv"
        path.write_text(path.read_text()[:-30])
        self.refuses("line 49", "fields")

    def test_an_open_quote(self):
        self.table([record()])
        with open(self.directory / "records.csv", "a", encoding="utf-8") as file:
            file.write('"open')
        self.refuses("line 3")

    def test_bytes_that_are_no_text(self):
        (self.directory / "records.csv").write_bytes(b"trial,\xff\xfe")
        self.refuses("UTF-8")
        self.table([record(), record(seed=2, trial="a\0b")])
        self.refuses("line 3 holds a NUL")

    def test_numbers_that_are_none(self):
        for column, text in (("rmse", "nan"), ("mean_ratio", "inf"), ("total_s", "fast"), ("leak_energy", "-nan"),
                             ("rmse", "-0.1")):
            with self.subTest(column=column, text=text):
                self.table([record(), record(seed=2, trial="the-broken-one", **{column: text})])
                self.refuses("line 3", "the-broken-one", column, f'"{text}"')

    def test_an_unknown_status(self):
        self.table([record(status="finished")])
        self.refuses("line 2", '"finished"', "known: done, failed")

    def test_no_trial_done(self):
        self.table([record(status="failed"), record(status="timeout")])
        self.refuses("no row has the status done (1 failed, 1 timeout)")

    def test_the_same_trial_twice(self):
        self.table([record(), record(photons=2000), record()])
        self.refuses("lines 2 and 4 are both of the trial pool-photonmap-1000-")
        self.table([record(), record(photons=2000), record(trial="another")])
        self.refuses("lines 2 and 4 have the same scene, method, parameters, seed and repeat")

    def test_usage(self):
        result = subprocess.run([sys.executable, str(TOOL)], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 2)


if __name__ == "__main__":
    unittest.main()
