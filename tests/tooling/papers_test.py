"""The papers' reproduction without rendering: numbers typed once and cited, verdicts, and committed pages that follow from their records."""
import importlib
import json
import math
import pathlib
import re
import shutil
import statistics
import struct
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

try:
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

from papers import chen_photons, chuang_counts, chuang_trees, entries, kept, latex, page, part, study, verdict
from report import exr, intervals, paper
from report.records import RecordsError

RESULTS = ROOT / "results" / "papers"
PAPERS = {name: paper.Paper(name) for name in paper.NAMES}


# Chen's numbers that no claim divides: what is rendered has them.
IN_SCENES = {"glass_index": lambda scene: scene("scenes/bowl.json")["bowl"]["bsdf"]["int_ior"],
             "crystal_index": lambda scene: scene("scenes/crystal_bowl.json")["bowl"]["bsdf"]["int_ior"]["n_d"],
             "diffuse_hits": lambda scene: scene("papers/sweeps/chen2011_maps.json")["indirect"][0]["param"]["diffuse_bounces"][0]}


class Numbers(unittest.TestCase):
    def test_every_number_has_its_place_and_is_used(self):
        for name, each in PAPERS.items():
            used = {number for claim in each.text["claims"] for number in paper.numbers_of(claim)} | {number for _, number in each.text["seconds"]}
            sources = "".join(file.read_text(encoding="utf-8") for file in [*(ROOT / "tools" / "papers").glob("*.py"), *(ROOT / "tools" / "report").glob("*.py")])
            for number, entry in each.text["numbers"].items():
                self.assertRegex(entry["where"], r"sec\. \d|figure \d|Definitions|Tracing Pass", f"{name}: {number}")
                quoted = number in used or f'"{number}"' in sources or number.startswith("figure1_rendering")
                self.assertTrue(quoted or number in IN_SCENES or number == "spread_threshold", f"{name}: {number} is used nowhere")

    def test_no_tool_types_them_again(self):
        """Of three digits and more; shorter ones occur by chance."""
        digits = lambda value: len(str(value).replace(".", "").strip("0"))
        telling = {str(entry["value"]) for each in PAPERS.values() for entry in each.text["numbers"].values() if digits(entry["value"]) >= 3}
        for file in [*(ROOT / "tools").glob("*.py"), *(ROOT / "tools" / "papers").glob("*.py"), *(ROOT / "tools" / "report").glob("*.py")]:
            typed = set(re.findall(r"[\d.]*\d", file.read_text(encoding="utf-8").replace("_", "").replace(",", ""))) & telling
            self.assertFalse(typed, file.name)

    def test_chens_scenes_have_his_numbers(self):
        chen = PAPERS["chen2011"]
        scene = lambda name: json.loads((ROOT / "experiments" / name).read_text(encoding="utf-8"))
        for name, found in IN_SCENES.items():
            self.assertEqual(found(scene), chen.number(name), name)

    def test_sweeps_render_with_the_papers_numbers(self):
        jensen = PAPERS["jensen1996"]
        for name, number in (("figure1", "figure1_photons"), ("figure2", "figure2_photons"), ("figure2", "figure2_reference_photons"),
                             ("figure3", "figure3_photons")):
            sweep = json.loads((paper.FOLDER / "sweeps" / f"jensen1996_{name}.json").read_text(encoding="utf-8"))
            photons = sweep["methods"][0]["param"]["photons"]
            self.assertIn(jensen.number(number), photons if isinstance(photons, list) else [photons])
        cells = json.loads((paper.FOLDER / "sweeps" / "chuang1995_counts.json").read_text(encoding="utf-8"))["set"]["cells"]["values"]
        self.assertIn(PAPERS["chuang1995"].number("polygons"), [a * b for a, b in cells])

    def test_chuangs_sweeps_follow_one_event(self):
        for file in (paper.FOLDER / "sweeps").glob("chuang1995_*.json"):
            for method in json.loads(file.read_text(encoding="utf-8"))["methods"]:
                if method["method"] != "none":
                    self.assertEqual(method["param"]["max_bounces"], 1, file.name)

    def test_sweeps_that_are_named_are_there(self):
        for name, each in PAPERS.items():
            for sweep in [*each.text["quick"], *each.text["two_at_a_time"]]:
                self.assertTrue((paper.FOLDER / "sweeps" / f"{name}_{sweep}.json").is_file(), f"{name}: {sweep}")

    def test_ratios_come_from_the_numbers(self):
        claims = {claim["id"]: claim for claim in PAPERS["jensen1996"].text["claims"]}
        value = lambda name: PAPERS["jensen1996"].value(claims[name])
        self.assertAlmostEqual(value("ball_unbalanced"), 378 / 182)
        self.assertAlmostEqual(value("photon_cognac"), (900 / 352497) / (58 / 250677))
        self.assertIsNone(value("ring_fixed"))
        self.assertEqual(PAPERS["jensen1996"].region(claims["ball_balancing"]), (-math.inf, 60 / 1140))

    def test_a_claim_without_its_number_is_refused(self):
        broken = paper.Paper("chuang1995")
        broken.text["claims"][0]["paper"] = {"number": "nowhere"}
        with self.assertRaisesRegex(RecordsError, 'no number "nowhere"'):
            paper.check(broken)

    def test_reasons_of_what_cannot_fail_or_is_missing_are_said(self):
        for more, told in (({"by_construction": " "}, "by_construction needs"), ({"missing": True}, "missing needs"),
                           ({"by_construction": "a", "missing": "b"}, "exclude each other"), ({"signed": "yes"}, "true or false")):
            broken = paper.Paper("chuang1995")
            broken.text["claims"][0] |= more
            with self.assertRaisesRegex(RecordsError, told):
                paper.check(broken)

    def test_the_dolphin_is_what_its_script_makes(self):
        make = importlib.import_module("make_dolphin")
        target = make.TARGET
        kept = (ROOT / target).read_bytes()
        vertices = sum(len(own) for own, _ in make.parts())
        self.assertIn(f"element vertex {vertices}\n".encode(), kept)
        first = next(make.parts())[0][0]
        self.assertEqual(struct.unpack("<3f", kept.partition(b"end_header\n")[2][:12]), tuple(np.float32(first)))


class Verdicts(unittest.TestCase):
    def judge(self, samples, region, **more):
        return verdict.judge(verdict.Measured(samples, **more), region)[0]

    def test_a_trend_needs_three_samples_and_order_at_95_per_cent(self):
        above = (1, math.inf)
        self.assertEqual(self.judge([1.2, 1.3], above), verdict.UNDECIDED)
        self.assertEqual(self.judge([1.2, 1.3, 1.25], above), verdict.HOLDS)
        self.assertEqual(self.judge([0.8, 0.82, 0.79], above), verdict.FAILS)
        self.assertEqual(self.judge([0.9, 1.5, 1.0], above), verdict.UNDECIDED)
        self.assertEqual(self.judge([], above), verdict.UNMEASURED)

    def test_95_of_100_intervals_hold_the_mean(self):
        """Intervals of ratios, whose logarithms scatter evenly, and of signed quantities about 0 hold the truth 95 times of 100."""
        random = np.random.default_rng(95)
        draws = 5_000
        for seeds in (3, 5, 10):
            normal = random.standard_normal((draws, seeds))
            for what, samples, is_signed, mean in (("ratios", np.exp(0.1 * normal), False, 1.0), ("signed", normal, True, 0.0)):
                ends = [verdict.interval(list(map(float, each)), False, is_signed) for each in samples]
                self.assertTrue(0.94 <= sum(low <= mean <= high for low, high in ends) / draws <= 0.96, f"{what}, {seeds} seeds")

    def test_what_only_happens_to_be_positive_decides_no_sign(self):
        samples = [0.01, 2.0, 0.02]
        self.assertEqual(verdict.judge(verdict.Measured(samples), (0, math.inf), True)[0], verdict.UNDECIDED)

    def test_one_function_makes_every_interval(self):
        """Student's quantile, and the normal one of two sides, are nowhere but in report/intervals."""
        another = re.compile(r"stdtrit|\bt\.(?:ppf|isf|interval)\(|norm\.(?:ppf|interval)\(|NormalDist|\b1\.96\b|\b1\.645\b|CONFIDENCE\b")
        found = {str(file.relative_to(ROOT)): another.findall(file.read_text(encoding="utf-8")) for file in (ROOT / "tools").rglob("*.py")}
        self.assertEqual({name for name, words in found.items() if words}, {"tools/report/intervals.py"})
        self.assertAlmostEqual(intervals.student(2), 4.302653, 5)
        values = [1.0, 2.0, 4.0, 8.0]
        low, high = verdict.interval(values, False, True)
        self.assertAlmostEqual((high - low) / 2, intervals.half_interval(values))

    def test_an_interval_is_students(self):
        low, high = verdict.interval([-1.0, 0.0, 1.0], False)
        self.assertAlmostEqual(high, 4.302653 / math.sqrt(3), 5)
        self.assertAlmostEqual(low, -high)
        low, high = verdict.interval([1.0, 2.0, 4.0], False)
        self.assertAlmostEqual(low * high, 4)

    def test_counted_values_need_no_repeats(self):
        self.assertEqual(self.judge([0], (0, 0), counted=True), verdict.HOLDS)
        self.assertEqual(self.judge([1], (0, 0), counted=True), verdict.FAILS)

    def test_equality_has_to_be_shown(self):
        region = (0.9, 1.1)
        self.assertEqual(self.judge([1.0, 1.01, 0.99], region), verdict.HOLDS)
        self.assertEqual(self.judge([1.0, 1.3, 0.8], region), verdict.UNDECIDED)
        self.assertEqual(self.judge([1.5, 1.51, 1.49], region), verdict.FAILS)

    def test_what_cannot_fail_and_what_is_partly_built_have_words_of_their_own(self):
        of = verdict.of_claim
        self.assertEqual(of(verdict.HOLDS, {"by_construction": "bytes times photons"}), verdict.BY_CONSTRUCTION)
        self.assertEqual(of(verdict.HOLDS, {"missing": "the volume map"}), verdict.PARTLY)
        self.assertEqual(of(verdict.HOLDS, {}), verdict.HOLDS)
        for other in (verdict.FAILS, verdict.UNDECIDED, verdict.UNMEASURED):
            self.assertEqual([of(other, {"by_construction": "x"}), of(other, {"missing": "x"})], [other, other])

    def test_pairs_have_to_match(self):
        self.assertEqual(verdict.ratio([2, 9], [1, 3], "s").samples, [2, 3])
        with self.assertRaises(ValueError):
            verdict.ratio([1, 2], [1], "s")


class Necks(unittest.TestCase):
    """Eq. 2 of Chuang and Cheng on beams whose neck is known."""

    def beam(self, neck):
        """A square beam that is narrowest at a share of its way of 1 m down; beyond 1 it converges all along."""
        corners = np.array([(-1, -1), (-1, 1), (1, -1), (1, 1)]) * 0.1
        starts = np.column_stack([corners, np.zeros(4)])[:, None]
        towards = np.column_stack([0.2 * corners, np.full(4, -neck)])
        rays = (towards - starts[:, 0]) / np.linalg.norm(towards - starts[:, 0], axis=1, keepdims=True)
        return chuang_trees.Widths(starts, rays[:, None], np.array([[0.0, 0, -1]]), -1.0)

    def test_a_circle_is_the_smallest(self):
        points = np.array([[0, 0], [2, 0], [1, 0.1], [1, -0.2]], float)[..., None]
        self.assertAlmostEqual(chuang_trees.circle(points)[0], 1.0)
        corners = np.array([[math.cos(a), math.sin(a)] for a in (0, 2, 4, 5)], float)[..., None]
        self.assertAlmostEqual(chuang_trees.circle(corners)[0], 1.0)

    def test_the_width_of_a_beam_is_known(self):
        self.assertAlmostEqual(self.beam(0.5)(0.0)[0], 0.1 * math.sqrt(2))
        self.assertAlmostEqual(self.beam(1.0)(1.0)[0], 0.02 * math.sqrt(2))

    def test_the_bracket_is_there_only_where_the_middle_is_narrowest(self):
        for neck, has_neck, has_bracket in ((0.5, True, True), (0.15, True, False), (3.0, False, False)):
            widths = self.beam(neck)
            self.assertEqual((bool(chuang_trees.has_neck(widths)[0]), bool(chuang_trees.printed(widths)[0][0])), (has_neck, has_bracket), neck)


class Words(unittest.TestCase):
    def test_a_window_of_heights_is_named_with_what_lies_beyond(self):
        heights = ["1", "1.5", "2", "3", "4"]
        of = lambda *holds: chuang_counts.window(heights, [bool(each) for each in holds])
        self.assertEqual(of(0, 1, 1, 1, 0), "holds from waves x 1.5 to x 3, and not at x 1 and x 4")
        self.assertEqual(of(1, 1, 1, 0, 0), "holds from waves x 1 to x 2, and not at x 3")
        self.assertEqual(of(1, 1, 1, 1, 1), "holds from waves x 1 to x 4, all that were tried")
        self.assertEqual(of(0, 0, 1, 0, 0), "holds at waves x 2, and not at x 1.5 and x 3")
        self.assertEqual(of(1, 0, 1, 0, 0), "holds at waves x 1, 2 of 1, 1.5, 2, 3, 4")
        self.assertEqual(of(0, 0, 0, 0, 0), "holds at none of the heights from x 1 to x 4")

    def test_chens_pictures_are_made_at_the_studys_n(self):
        for name in ("bowls", "bowls_crystal", "events", "events_crystal", "interaction", "oversampling_adaptive", "oversampling_uniform"):
            sweep = json.loads((paper.FOLDER / "sweeps" / f"chen2011_{name}.json").read_text(encoding="utf-8"))
            own = [method["param"]["nearest"] for method in sweep["methods"] if method["method"] == "photonmap"]
            self.assertEqual(own, [chen_photons.STUDY_N], name)

    def test_an_ambient_term_is_fitted_to_the_truth(self):
        random = np.random.default_rng(3)
        ambient, direct = random.random((4, 5, 3)), random.random((4, 5, 3))
        layers = {"": direct + ambient, "ambient": ambient}
        seen = np.ones((4, 5), bool)
        self.assertAlmostEqual(chen_photons.fitted(layers, direct + 2.5 * ambient, seen), 2.5)
        self.assertEqual(chen_photons.fitted(layers, direct - ambient, seen), 0.0, "never below nothing")


class Pictures(unittest.TestCase):
    def test_what_is_written_is_read_again(self):
        picture = np.random.default_rng(1).random((37, 23, 3)).astype(np.float16).astype(np.float32)
        file = pathlib.Path(self.enterContext(__import__("tempfile").TemporaryDirectory())) / "a.exr"
        file.write_bytes(exr.encode(picture))
        np.testing.assert_array_equal(exr.read_layers(file)[""], picture)


class Latex(unittest.TestCase):
    def test_every_letter_has_an_ascii_form(self):
        self.assertEqual(latex.escaped("10⁻⁴ m², 5 %"), r"10$^{-4}$ m$^{2}$, 5 \%")
        with self.assertRaises(ValueError):
            latex.escaped("☃")

    def test_a_line_is_shared_among_the_columns(self):
        table = part.Table("a", "A table", ["claim", "x"], [["a long text " * 10, "1"]])
        shares = [float(each) for each in re.findall(r"\\dimexpr ([\d.]+)", latex.columns(table))]
        self.assertAlmostEqual(sum(shares), 1, 2)
        self.assertGreater(shares[0], 3 * shares[1])

    def test_committed_tables_are_ascii(self):
        for name in paper.NAMES:
            self.assertTrue((RESULTS / name / "tables.tex").read_text(encoding="utf-8").isascii(), name)


def rounded(value):
    """The value with its numbers to seven digits."""
    if isinstance(value, float):
        return float(f"{value:.7g}")
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    return [rounded(each) for each in value] if isinstance(value, list) else value


class Sections(unittest.TestCase):
    """A run of some sections into an earlier one: rows, tables and figures of the others stay."""

    def setUp(self):
        self.study = types.SimpleNamespace(paper=PAPERS["jensen1996"], output=RESULTS / "jensen1996", cost=lambda names: study.Cost("causticbench x", 60.0, 10**6) if names else study.Cost())
        self.modules = [importlib.import_module(f"papers.{name}") for name in PAPERS["jensen1996"].text["parts"]]
        self.order = list(kept.sections(self.modules))

    def test_names_differ_and_every_kept_piece_has_one(self):
        for name, each in PAPERS.items():
            modules = [importlib.import_module(f"papers.{module}") for module in each.text["parts"]]
            order = kept.sections(modules)
            self.assertEqual(len(order), sum(len(module.SECTIONS) for module in modules), name)
            rows, pieces = kept.read(RESULTS / name)
            named = {each["section"] for each in [*rows, *pieces["tables"], *pieces["figures"]] if each.get("verdict") != verdict.UNMEASURED}
            self.assertLessEqual(named, set(order), name)

    def test_one_section_is_made_anew(self):
        part_run = part.Part({"view_independent": verdict.counted(0.5, "W")}, [], [], {}).of("one-map")
        rows, pieces = kept.of_some(self.study, part_run, "another machine.", self.order, ["one-map"])
        old_rows, old_pieces = kept.read(self.study.output)
        for row, old in zip(rows, old_rows):
            if row["id"] == "view_independent":
                self.assertEqual((row["verdict"], row["section"], row["megabytes"]), (verdict.FAILS, "one-map", 1.0))
            else:
                # Quantiles of Student's t differ between releases of SciPy in the tenth digit.
                self.assertEqual(rounded(row), rounded(old))
        self.assertEqual([pieces["tables"], pieces["figures"]], [old_pieces["tables"], old_pieces["figures"]])
        self.assertIn("one-map on another machine", kept.made_on(pieces))

    def test_single_sections_need_no_earlier_run(self):
        with tempfile.TemporaryDirectory() as folder:
            self.study.output, self.study.minutes, self.study.cpu_minutes = pathlib.Path(folder), lambda: 1.0, lambda: 2.0
            part_run = part.Part({"view_independent": verdict.counted(0.5, "W")}).of("one-map")
            rows, pieces = kept.of_some(self.study, part_run, "this machine.", self.order, ["one-map"])
        self.assertEqual([row["id"] for row in rows if row["verdict"] != verdict.UNMEASURED], ["view_independent"])
        self.assertEqual(page.made(pieces), "section by section: one-map on this machine.")
        self.assertEqual(page.took(pieces), "single sections")

    def test_names_are_read_without_running_the_parts(self):
        for name, each in PAPERS.items():
            for module in each.text["parts"]:
                self.assertEqual(kept.section_names(module), list(importlib.import_module(f"papers.{module}").SECTIONS), name)

    def test_tables_of_a_section_are_replaced(self):
        table = part.Table("figure1", "New", ["a"], [["b"]])
        _, pieces = kept.of_some(self.study, part.Part({}, [table]).of("figure1"), "", self.order, ["figure1"])
        self.assertEqual([each["title"] for each in pieces["tables"] if each["section"] == "figure1"], ["New"])
        self.assertEqual([each["section"] for each in pieces["tables"]], sorted((each["section"] for each in pieces["tables"]), key=self.order.index))

    def test_a_claim_that_nothing_has_run_for_is_not_measured(self):
        rows = entries.entries(self.study, part.Part(), {})
        self.assertEqual({row["verdict"] for row in rows}, {verdict.UNMEASURED})
        self.assertIn("not run yet", rows[0]["note"])
        with self.assertRaisesRegex(ValueError, "claims without a measurement"):
            entries.entries(self.study, part.Part())

    def test_a_changed_region_judges_an_earlier_row_anew(self):
        claim = dict(self.study.paper.text["claims"][0], region={"above": 99})
        row = entries.of_claim(self.study, claim, None, kept.read(self.study.output)[0][0])
        self.assertEqual((row["verdict"], row["region"]), (verdict.FAILS, "at least 99"))

    def test_an_earlier_row_gets_its_interval_from_its_values(self):
        claim = self.study.paper.text["claims"][0] | {"region": {"above": 0.1}, "by_construction": "it is put in"}
        kept_row = kept.read(self.study.output)[0][0] | {"values": [0.5, 1.0, 2.0], "counted": False, "interval": [0.9, 1.1]}
        row = entries.of_claim(self.study, claim, None, kept_row)
        self.assertEqual((row["verdict"], row["by_construction"]), (verdict.BY_CONSTRUCTION, "it is put in"))
        self.assertAlmostEqual(math.log(row["interval"][1]), 4.302653 * math.log(2) / math.sqrt(3), 5)

    def test_what_stands_beside_a_counter_is_shown_and_not_judged(self):
        claim = self.study.paper.text["claims"][0] | {"region": {"below": 1}}
        row = entries.of_claim(self.study, claim, verdict.Measured([0.5], counted=True, beside={"CPU time": [2.0, 3.0, 2.5]}), None)
        self.assertEqual(row["verdict"], verdict.HOLDS)
        self.assertEqual(page.notes(row), "Beside it, not judged: CPU time 2.5 (2–3).")


class Pages(unittest.TestCase):
    """What is committed in results/papers: pages follow from verdicts.json and tables.json, and both from the papers' claims."""

    def committed(self):
        for name, each in PAPERS.items():
            folder = RESULTS / name
            if (folder / "verdicts.json").is_file():
                read = lambda file: json.loads((folder / file).read_text(encoding="utf-8"))
                yield each, folder, read("verdicts.json"), read("tables.json")

    def test_all_three_papers_are_there(self):
        self.assertEqual([folder.name for _, folder, _, _ in self.committed()], list(paper.NAMES))

    def test_verdicts_answer_the_claims(self):
        for each, folder, found, _ in self.committed():
            claims = each.text["claims"]
            self.assertEqual([entry["id"] for entry in found], [claim["id"] for claim in claims], folder)
            for entry, claim in zip(found, claims):
                place = f"{folder.name}: {entry['id']}"
                self.assertEqual(entry["paper"], entries.stated(each, claim), place)
                theirs = each.value(claim)
                self.assertEqual(entry["paper_ratio"], theirs if "ratio" in claim["paper"] else None, place)
                self.assertEqual(entry["region"], entries.shown(each.region(claim)), place)
                for key in ("group", "claim", "where", "unit", "tolerance_from"):
                    self.assertEqual(entry[key], claim[key], place)
                for key in ("by_construction", "missing"):
                    self.assertEqual(entry[key], claim.get(key, ""), place)

    def test_verdicts_follow_from_their_intervals(self):
        for each, folder, found, _ in self.committed():
            for entry, claim in zip(found, each.text["claims"]):
                place = f"{folder.name}: {entry['id']}"
                if entry["verdict"] == verdict.UNMEASURED:
                    self.assertTrue(entry["note"], place)
                    continue
                low, high = each.region(claim)
                if entry["interval"] is None:
                    self.assertEqual((entry["verdict"], entry["samples"] < verdict.LEAST_SAMPLES), (verdict.UNDECIDED, True), place)
                    continue
                left, right = entry["interval"]
                inside, outside = low <= left and right <= high, right < low or left > high
                word = verdict.BY_CONSTRUCTION if "by_construction" in claim else verdict.PARTLY if "missing" in claim else verdict.HOLDS
                self.assertEqual(entry["verdict"], word if inside else verdict.FAILS if outside else verdict.UNDECIDED, place)
                self.assertTrue(entry["command"] and "causticbench" in entry["command"], place)

    def test_intervals_follow_from_their_values(self):
        for each, folder, found, _ in self.committed():
            for entry, claim in zip(found, each.text["claims"]):
                place, values = f"{folder.name}: {entry['id']}", entry["values"]
                self.assertEqual(entry["samples"], len(values), place)
                if not values:
                    continue
                self.assertEqual((entry["ours"], entry["spread"]), (statistics.median(values), [min(values), max(values)]), place)
                ends = verdict.interval(values, entry["counted"], claim.get("signed", False))
                self.assertEqual(entry["interval"] is None, ends is None, place)
                slack = 1e-8 * max(map(abs, ends or [0]))  # Student's quantile of SciPy 1.10 errs by 2e-9, that of 1.15 does not
                for kept_end, end in zip(entry["interval"] or [], ends or []):
                    self.assertAlmostEqual(kept_end, end, delta=slack, msg=place)
                if len(entry["made_of"]) == 2:
                    top, bottom = (part["values"] for part in entry["made_of"])
                    for value, a, b in zip(values, top, bottom, strict=True):
                        self.assertTrue(math.isclose(value, a / b, rel_tol=1e-9), place)
                self.assertEqual(entry["bounds"], [None if math.isinf(end) else end for end in each.region(claim)], place)

    def test_pages_and_tables_follow_from_them(self):
        for each, folder, found, kept in self.committed():
            for name, text in page.rendered(each, found, kept).items():
                self.assertEqual((folder / name).read_text(encoding="utf-8"), text, f"{folder.name}/{name}")

    def test_one_claim_holds_and_two_hold(self):
        of = lambda *verdicts: page.tally([{"verdict": each} for each in verdicts])
        self.assertEqual(of("holds", "holds", "does not hold"), "2 hold, 1 does not hold")
        self.assertEqual(of("does not hold", "does not hold", "holds", "undecided"), "1 holds, 2 do not hold, 1 undecided")
        self.assertEqual(of("by construction", "holds", "partly", "by construction"), "1 holds, 1 holds partly, 2 hold by construction")

    def test_every_figure_is_there_and_in_the_gallery(self):
        gallery = (RESULTS / "README.md").read_text(encoding="utf-8")
        for _, folder, _, kept in self.committed():
            for figure in kept["figures"]:
                self.assertTrue((folder / "figures" / f"{figure['name']}.png").is_file(), figure["name"])
                self.assertIn(f"{folder.name}/figures/{figure['name']}.png", gallery)

    def test_no_page_names_a_path_of_a_machine(self):
        for _, folder, _, _ in self.committed():
            for name in ("index.html", "tables.md", "verdicts.json"):
                self.assertNotIn(str(ROOT), (folder / name).read_text(encoding="utf-8"))


class CommandLine(unittest.TestCase):
    def run_tool(self, *words):
        return subprocess.run([sys.executable, ROOT / "tools" / "reproduce.py", *words], capture_output=True, text=True)

    def test_unknown_papers_and_missing_programs_are_named(self):
        done = self.run_tool("jensen1995")
        self.assertEqual(done.returncode, 2)
        self.assertIn("known: jensen1996, chuang1995, chen2011", done.stderr)
        done = self.run_tool("jensen1996", "--program", "/nowhere/causticbench")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        self.assertEqual(self.run_tool("--quick", "--full").returncode, 2)

    def test_sections_are_known_by_name(self):
        done = self.run_tool("chuang1995", "--only", "figure1", "--program", sys.executable)
        self.assertEqual(done.returncode, 2)
        self.assertIn("known: chuang1995: counts, ", done.stderr)
        self.assertEqual(self.run_tool("--only", "counts", "--pages").returncode, 2)
        done = self.run_tool("--pages", "-o", "/nowhere")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no earlier run", done.stderr)

    def test_records_are_compared_alone(self):
        for more in (("--pages",), ("--only", "counts"), ("--full",), ("-o", "/nowhere")):
            done = self.run_tool("--compare", *more)
            self.assertEqual(done.returncode, 2, more)
            self.assertIn("--compare: ", done.stderr, more)

    def test_records_of_any_folder_are_compared_with_the_published_ones(self):
        with tempfile.TemporaryDirectory() as folder:
            own = pathlib.Path(folder) / "chuang1995" / "records"
            own.mkdir(parents=True)
            shutil.copy(RESULTS / "chuang1995" / "records" / "height.csv", own)
            done = self.run_tool("--compare", "-o", folder)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertRegex(done.stdout, r"^chuang1995/records/\w+\.csv: [1-9]\d* trials in both, 0 differ, 0 in one only\n$")

    def test_a_run_leaves_the_published_pages_alone(self):
        """A program that fails at its first command tells where it would have written."""
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "causticbench"
            program.write_text("#!/bin/sh\necho \"$@\" >&2\nexit 4\n")
            program.chmod(0o755)
            own = lambda *words: self.run_tool("chuang1995", "--only", "heights", "--program", program, *words).stderr
            self.assertIn(f"-o {ROOT}/out/papers/chuang1995/trials/height", own())
            self.assertIn(f"-o {folder}/mine/chuang1995/trials/height", own("-o", f"{folder}/mine"))
            self.assertIn(f"-o {RESULTS}/chuang1995/trials/height", own("--keep"))
        self.assertIn("/out/", (ROOT / ".gitignore").read_text(encoding="utf-8").splitlines())

    def test_a_smoke_run_is_one_section_in_a_folder_of_its_own(self):
        import reproduce

        with unittest.mock.patch.object(sys, "argv", ["reproduce.py", "--smoke"]):
            chosen = reproduce.arguments()
        self.assertEqual((chosen.papers, chosen.only, chosen.output), (["chen2011"], ["prism"], ROOT / "out" / "papers-smoke"))
        for word in ("--pages", "--compare"):
            with unittest.mock.patch.object(sys, "argv", ["reproduce.py", "--smoke", word]):
                chosen = reproduce.arguments()
            self.assertEqual((chosen.papers, chosen.only), (["chen2011"], []), f"{word} takes what a smoke run made")
        sweep = json.loads((study.SWEEPS / "chen2011_prism.json").read_text(encoding="utf-8"))
        self.assertEqual(len(sweep["scenes"]), 1)

    def test_trials_are_compared_by_picture_and_counts(self):
        import reproduce

        heading = "trial,picture_hash,photons_stored,total_s"
        before = reproduce.by_trial(f"{heading}\na,1,5,0.1\nb,2,5,0.1\n")
        now = reproduce.by_trial(f"{heading}\na,1,5,9\nb,3,5,0.1\n")
        self.assertEqual([trial for trial in before if before[trial] != now[trial]], ["b"])
        self.assertEqual(reproduce.by_trial("seed,error\n1,0.5\n"), {}, "a table that is not of trials")


if __name__ == "__main__":
    unittest.main()
