"""Jensen 1996, figure 1: the cardioid in a ring at four alphas, its times, rays, noise and memory, over N, view and bound."""
import json
import statistics

from papers.figures import strip, white
from papers.jensen_cardioid import ALPHAS, EYES
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, pairs, ratio
from papers.words import short, spread
from report.records import natural

FIXED, ADAPTIVE = 4, 256  # most samples a pixel
FIXED_ROWS = {"0.5": "ring_fixed_0.5", "0.1": "ring_fixed_0.1", "0.01": "ring_fixed"}


def times(study):
    trials = study.sweep("figure1")
    maps = lambda column, alpha, most, **more: trials.column(column, method="photonmap", alpha=alpha, max_samples=most, **more)
    seconds = lambda alpha, most=ADAPTIVE: maps("render_cpu_s", alpha, most)
    bare = lambda alpha, most: trials.column("render_cpu_s", method="none", alpha=alpha, max_samples=most)
    map_bytes, photons = maps("map_bytes", "1", FIXED)[0], maps("photons_stored", "1", FIXED)[0]
    noisier = ratio(noise(trials, "0.01"), noise(trials, "1"), "of the squared caustic", note=f"by disjoint pairs of seeds, {n_of(trials)}")
    part = Part()
    for alpha, before in zip(ALPHAS[1:], ALPHAS):
        part.measured[f"ring_time_{alpha}"] = ratio(seconds(alpha), seconds(before), "CPU s")
        part.measured[f"ring_rays_{alpha}"] = ratio(maps("camera_rays", alpha, ADAPTIVE), maps("camera_rays", before, ADAPTIVE), "rays")
    part.measured |= {
        "ring_time": ratio(seconds("0.01"), seconds("1"), "CPU s", note=f"{n_of(trials)}, which the paper does not give: "
                           f"{over_n(growth(study, 'render_cpu_s'))}"),
        "ring_bare": ratio(bare("1", FIXED), seconds("1", FIXED), "CPU s"),
        "ring_preprocess": ratio(preprocess(trials, alpha=1, max_samples=FIXED, method="photonmap"), seconds("1", FIXED), "CPU s"),
        "ring_photons": noisier,
        "ring_megabytes": counted(map_bytes / 1e6, "MB", "follows from the paper's photons and the bytes of one"),
        "ring_megabytes_glossy": Measured([map_bytes / 1e6 * each for each in noisier.samples], unit="MB",
                                          note="so many photons in discs of one size have at alpha 0.01 the noise of alpha 1; the "
                                          "paper's own figure 1 has the same photons at all four"),
        "photon_bytes": counted(map_bytes / photons, "bytes", f"{short(map_bytes)} bytes over {short(photons)} photons"),
    }
    part.tables.append(pictures_table(study, trials))
    part.figures += pictures(trials, study.paper.number("figure1_photons"))
    return part


def counts(study):
    """The work of a picture by counters: at a fixed rate the same for all alphas, by adaptive sampling the same a ray."""
    trials = study.sweep("figure1_counts")
    nodes = lambda alpha, most: [each / 1e6 for each in trials.column("nodes_visited", alpha=alpha, max_samples=most)]
    seconds = lambda alpha, most: trials.column("render_cpu_s", alpha=alpha, max_samples=most)
    a_ray = lambda some, alpha: [each / n for each, n in zip(some(alpha, ADAPTIVE), trials.column("camera_rays", alpha=alpha, max_samples=ADAPTIVE))]
    times = lambda top, bottom: {"ratio of CPU times": ratio(top, bottom, "").samples}
    found = {FIXED_ROWS[alpha]: ratio(nodes(alpha, FIXED), nodes("1", FIXED), "million nodes visited",
                                      beside=times(seconds(alpha, FIXED), seconds("1", FIXED))) for alpha in ALPHAS[1:]}
    millionth = lambda some, alpha: [1e6 * each for each in a_ray(some, alpha)]
    return Part(found | {"ring_reason": ratio(millionth(nodes, "0.01"), millionth(nodes, "1"), "nodes visited a ray",
                                              beside=times(a_ray(seconds, "0.01"), a_ray(seconds, "1")))})


def pictures_table(study, trials):
    maps = lambda column, alpha, most: trials.column(column, method="photonmap", alpha=alpha, max_samples=most)
    seconds = lambda alpha, most: maps("render_cpu_s", alpha, most)
    pixels = study.paper.number("figure1_width") * study.paper.number("figure1_height")
    over = lambda alpha, most: spread(ratio(seconds(alpha, most), seconds("1", most), "").samples)
    theirs = lambda alpha: study.paper.number(f"figure1_rendering_{alpha}_s") / study.paper.number("figure1_rendering_1_s")
    rows = [[alpha, spread([n / pixels for n in maps("camera_rays", alpha, ADAPTIVE)]), spread(seconds(alpha, ADAPTIVE)), over(alpha, ADAPTIVE),
             short(theirs(alpha)), spread(seconds(alpha, FIXED)), over(alpha, FIXED),
             spread(trials.column("render_cpu_s", method="none", alpha=alpha, max_samples=ADAPTIVE))] for alpha in ALPHAS]
    return Table("figure1", "Figure 1: the four pictures",
                 ["alpha", "rays a pixel, adaptive", "CPU s", "over alpha 1", "the paper's", f"CPU s, {FIXED} rays a pixel", "over alpha 1",
                  "CPU s without caustic, adaptive"], rows,
                 f"{study.paper.number('figure1_photons'):,} photons, {n_of(trials)}, {len(trials.values('seed'))} seeds; adaptive: {FIXED} to "
                 f"{ADAPTIVE} rays, until the standard error is 2 % of the pixel.")


def n_of(trials):
    """Of the photons of an estimate, where a sweep has one number of them."""
    return "N = " + ", ".join(trials.values("nearest"))


def noise(trials, alpha):
    """Variance of the caustic over its square, by disjoint pairs of seeds."""
    some = [layers["caustic"] for layers in trials.pictures(method="photonmap", alpha=alpha, max_samples=ADAPTIVE)]
    return [float(((a - b) ** 2).mean() / 2 / (((a + b) / 2) ** 2).mean()) for a, b in pairs(some)]


def growth(study, column):
    """{N: what a column has at alpha 0.01 over alpha 1, one a seed}: the paper does not give N."""
    main, others = study.sweep("figure1"), study.sweep("figure1_nearest")
    seeds = len(others.values("seed"))
    over = lambda trials, **wanted: ratio(*(trials.column(column, method="photonmap", alpha=alpha, max_samples=ADAPTIVE, **wanted)[:seeds]
                                            for alpha in ("0.01", "1")), "").samples
    found = {nearest: over(trials, nearest=nearest) for trials in (main, others) for nearest in trials.values("nearest")}
    return {nearest: found[nearest] for nearest in sorted(found, key=natural)}


def over_n(found):
    """The middle of each N as words."""
    return ", ".join(f"{statistics.median(samples):.3g} at N = {nearest}" for nearest, samples in found.items())


def preprocess(trials, **wanted):
    """CPU seconds of tracing photons and building their tree."""
    return [a + b for a, b in zip(trials.column("precompute_cpu_s", **wanted), trials.column("balance_cpu_s", **wanted))]


def pictures(trials, photons):
    shown = {alpha: trials.picture(method="photonmap", alpha=alpha, max_samples=ADAPTIVE, seed=1) for alpha in ALPHAS}
    title = lambda alpha: f"alpha = {alpha}"
    all_light = strip([[(title(alpha), shown[alpha][""]) for alpha in ALPHAS[:2]], [(title(alpha), shown[alpha][""]) for alpha in ALPHAS[2:]]])
    level = white(shown["1"]["caustic"])
    caustic = strip([[(title(alpha), shown[alpha]["caustic"]) for alpha in ALPHAS[:2]],
                     [(title(alpha), shown[alpha]["caustic"]) for alpha in ALPHAS[2:]]], level)
    return [Figure("figure1", "Figure 1: the cardioid as the floor becomes glossy",
                   "A lamp on the edge of a mirror ring; the floor's diffuse-specular component alpha falls from 1 to 0.01. All four at "
                   f"one exposure, {photons:,} photons, {n_of(trials)}, adaptive sampling. Seen from the lamp's side: from the opposite side "
                   "the lamp's own highlight covers the caustic at small alpha.", *all_light),
            Figure("figure1_caustic", "Figure 1: the caustic alone",
                   "The same pictures without direct light. Where the light of the cardioid arrives along the mirrored viewing ray "
                   "it stays; where it arrives from elsewhere it fades with alpha.", *caustic)]


def sensitivity(study):
    """The growth of times and rays over N: the paper does not give N."""
    main, others = study.sweep("figure1"), study.sweep("figure1_nearest")
    times_of, rays_of = growth(study, "render_cpu_s"), growth(study, "camera_rays")
    least = lambda found: min(found, key=lambda nearest: statistics.fmean(found[nearest]))
    rows = []
    for nearest in times_of:
        trials = main if nearest in main.values("nearest") else others
        pick = lambda alpha: spread(trials.column("render_cpu_s", method="photonmap", nearest=nearest, alpha=alpha, max_samples=ADAPTIVE))
        rows.append([nearest, pick("1"), pick("0.01"), spread(times_of[nearest]), spread(rays_of[nearest])])
    worst = {name: Measured(found[least(found)], note=over_n(found)) for name, found in (("ring_time_any", times_of), ("ring_rays_any", rays_of))}
    table = Table("figure1_nearest", "Figure 1: how much N matters",
                  ["N", "CPU s at alpha 1", "CPU s at alpha 0.01", "CPU s, 0.01 over 1", "rays, 0.01 over 1"], rows,
                  f"Adaptive, as in the table above, {len(others.values('seed'))} seeds.")
    ends = lambda found: f"{over_n({nearest: found[nearest] for nearest in (rows[0][0], rows[-1][0])})}"
    return Part(worst, [table], facts={"ring_growth_over_n": ends(times_of), "ring_rays_over_n": ends(rays_of)})


def choices(study):
    """The growth seen from two eyes, with two bounds on a pixel's error."""
    trials = study.sweep("figure1_choices")
    over = lambda column, **wanted: trials.column(column, alpha="0.01", **wanted)[0] / trials.column(column, alpha="1", **wanted)[0]
    facts = {}
    for name, eye in EYES.items():
        for bound in trials.values("max_error"):
            grown = [over(column, eye=json.dumps(eye, separators=(",", ":")), max_error=bound) for column in ("camera_rays", "render_cpu_s")]
            facts[f"ring_{name}_{100 * float(bound):.0f}"] = f"rays {grown[0]:.3g} times, CPU s {grown[1]:.3g} times"
    return Part(facts=facts)


SECTIONS = {"figure1": times, "figure1-counts": counts, "figure1-nearest": sensitivity, "figure1-choices": choices}
