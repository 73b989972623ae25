"""Jensen 1996, figure 2: the shape of the caustic of a glass ball, oval on a Lambertian floor and curved on a glossy one."""
import copy
import dataclasses
import json
import math

import numpy as np
from matplotlib.colors import PowerNorm
from scipy.ndimage import gaussian_filter, map_coordinates

from papers.figures import luminance, plot, strip
from papers.jensen_cardioid import PHOTON_MAP
from papers.jensen_table import rendering
from papers.part import Figure, Part
from papers.verdict import Measured
from papers.words import spread
from report import exr

QUANTILE, THRESHOLD = 0.995, 0.3  # what belongs to the spot: above this share of that quantile
SCENE = "experiments/papers/scenes/jensen_ball.json"


class Floor:
    """Where on the floor, z = 0, a picture's pixels look, which of them see it first, and the light that they see there."""

    def __init__(self, layers, scene):
        view, fov = scene["sensor"]["to_world"][0]["look_at"], scene["sensor"]["fov"]
        self.origin, forward = np.array(view["origin"]), np.subtract(view["target"], view["origin"])
        forward = forward / np.linalg.norm(forward)
        right = np.cross(forward, view["up"])
        right /= np.linalg.norm(right)
        self.axes = np.stack([np.cross(right, forward), right, forward])
        self.height, self.width = layers[""].shape[:2]
        self.scale = self.width / 2 / math.tan(math.radians(fov) / 2)
        x, y = (np.arange(self.width) + 0.5 - self.width / 2) / self.scale, (self.height / 2 - np.arange(self.height) - 0.5) / self.scale
        rays = forward + x[None, :, None] * self.axes[1] + y[:, None, None] * self.axes[0]
        way = -self.origin[2] / rays[..., 2]
        self.points = (self.origin + way[..., None] * rays)[..., :2]
        albedo = layers["albedo"]
        self.seen = (rays[..., 2] < 0) & (albedo.max(axis=2) < 0.9)  # glass has an albedo of 1
        self.irradiance = np.where(self.seen, (layers["caustic"] / np.maximum(albedo, 1e-3)).mean(axis=2), 0)

    def at(self, places):
        """The light at places on the floor, between pixels; not a number outside the picture."""
        up, right, forward = np.moveaxis((np.concatenate([places, np.zeros((*places.shape[:-1], 1))], axis=-1) - self.origin) @ self.axes.T, -1, 0)
        pixels = [self.height / 2 - 0.5 - self.scale * up / forward, self.width / 2 - 0.5 + self.scale * right / forward]
        return map_coordinates(self.irradiance, pixels, order=1, cval=np.nan)


@dataclasses.dataclass
class Bend:
    """A spot's parabola y = c x² along its principal axes; index: c var x / sqrt(var y), 0 for an oval."""
    index: float
    level: float
    curve: np.ndarray


def bend(floor):
    level = THRESHOLD * np.quantile(floor.irradiance[floor.seen], QUANTILE)
    spot = floor.seen & (floor.irradiance > level)
    middle = floor.points[spot].mean(axis=0)
    points = floor.points[spot] - middle
    _, axes = np.linalg.eigh(np.cov(points.T))
    if axes[0, 1] < 0:
        axes[:, 1] *= -1  # along x, away from the lamp
    forth, side = axes[:, 1], np.array([-axes[1, 1], axes[0, 1]])
    along, across = points @ forth, points @ side
    parabola = np.polyfit(along, across, 2)
    x = np.linspace(*np.quantile(along, (0.01, 0.99)), 60)
    curve = middle + x[:, None] * forth + np.polyval(parabola, x)[:, None] * side
    return Bend(float(parabola[0] * along.var() / math.sqrt(across.var())), float(level), curve)


def shape(study):
    trials = study.sweep("figure2_shape")
    scene = study.scene(SCENE)
    floors = {alpha: [Floor(layers, scene) for layers in trials.pictures(alpha=alpha)] for alpha in ("1", "0.1")}
    bends = {alpha: [bend(floor).index for floor in own] for alpha, own in floors.items()}
    size = lambda alpha: [abs(each) for each in bends[alpha]]
    note, places = f"index {spread(bends['0.1'])} at alpha 0.1, {spread(bends['1'])} at alpha 1", elsewhere(study, scene)
    return Part({
        "ball_curved": Measured(size("0.1"), note=f"{note}; elsewhere, one seed each: {places['ball_20']} with the lamp 20 degrees high, "
                                f"{places['ball_40']} with it 40 degrees high, {places['ball_behind']} from behind the lamp"),
        "ball_oval": Measured(size("1"), note=note),
        "ball_bends": Measured([a - b for a, b in zip(size("0.1"), size("1"))], note=note)},
        figures=[overview(study, trials, floors, scene), spots(trials, floors, note)], facts=places)


def overview(study, trials, floors, scene):
    whole, lamp = study.sweep("figure2_overview"), scene["light"]["position"]
    fov = [each.record(each.where()[0])["scene"]["resolved"]["sensor"]["fov"] for each in (whole, trials)]
    pictures = []
    for alpha in floors:
        picture = whole.picture(alpha=alpha)[""]
        pictures.append((f"alpha = {alpha}", picture, float(np.percentile(luminance(picture), 99.7))))
    return Figure("figure2", "Figure 2: the caustic of a glass ball on glossy stone",
                  "The paper's picture has alpha = 0.1; beside it its Lambertian twin, each at its own exposure. "
                  f"{study.paper.number('figure2_photons'):,} photons, {rendering(whole)}. The lamp stands {elevation(lamp):.0f} degrees high, at "
                  f"the right; the eye looks across its light, {fov[0]} degrees wide; the shape, below, is measured in a view {fov[1]} degrees wide.",
                  *strip([pictures]))


def elevation(lamp):
    """In degrees, as the foot of the ball sees it."""
    return math.degrees(math.atan2(lamp[2], math.hypot(*lamp[:2])))


def spots(trials, floors, note):
    return Figure("figure2_shape", "Figure 2: oval at alpha 1, curved at alpha 0.1",
                  "The caustic alone as seen from straight above: the eye's pixels moved onto the floor, light over the floor's albedo, as a share "
                  f"of the spot's level (its quantile {QUANTILE:g}). Mean of {len(trials.values('seed'))} seeds. Blue: the contour at {THRESHOLD:g}, "
                  f"within which the spot is measured; red: its parabola. {note[0].upper()}{note[1:]}.", above(floors))


def above(floors):
    """PNG of the spots on the floor, with contour and parabola."""
    x, y = np.arange(0.32, 1, 0.0025), np.arange(-0.2, 0.25, 0.0025)
    grid = np.stack(np.meshgrid(x, y), axis=-1)

    def draw(*axes):
        for ax, (alpha, own) in zip(axes, floors.items()):
            mean = copy.copy(own[0])
            mean.irradiance = np.mean([floor.irradiance for floor in own], axis=0)
            found = bend(mean)
            light = mean.at(grid) / found.level * THRESHOLD
            drawn = ax.imshow(light, extent=(x[0], x[-1], y[0], y[-1]), origin="lower", cmap="gray", norm=PowerNorm(0.6, 0, 1.3))
            smooth = gaussian_filter(light, 2)
            ax.contour(x, y, smooth, [THRESHOLD], colors="#4aa3ff", linewidths=1.2)
            ax.plot(*found.curve.T, color="#ff5a4a", linewidth=1.6)
            ax.set(title=f"alpha = {alpha}, index {found.index:.2f}", xlabel="away from the lamp [m]", xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
        axes[0].set_ylabel("towards the eye [m]")
        axes[0].figure.colorbar(drawn, ax=list(axes), shrink=0.75, label="light on the floor")

    return plot(draw, 9, 3.4, 2)


def elsewhere(study, base):
    """The index where lamp and eye stand elsewhere, as words."""
    usual, height = base["light"]["position"], base["ball"]["center"][2]
    look = base["sensor"]["to_world"][0]["look_at"]
    middle, far, first = look["target"][0], math.hypot(usual[0], usual[2]), math.atan2(usual[2], -usual[0])
    facts = {}
    for degrees in (20, 40):
        angle = math.radians(degrees)
        lamp = [-far * math.cos(angle), 0, far * math.sin(angle)]
        spot = middle + height / math.tan(angle) - height / math.tan(first)
        facts[f"ball_{degrees}"] = index_at(study, f"lamp{degrees}", base, lamp, [spot, *look["origin"][1:]], spot)
    facts["ball_behind"] = index_at(study, "behind", base, usual, [-0.8, 0, 2], middle)
    return facts


def index_at(study, name, base, lamp, eye, spot):
    """The indices at both alphas as words."""
    scene = json.loads(json.dumps(base))
    scene["sensor"]["to_world"][0]["look_at"] |= {"origin": eye, "target": [spot, 0, 0]}
    look = "/sensor/to_world/0/look_at"
    found = []
    for alpha in (0.1, 1):
        file, = study.single("figure2_geometries", "render", [
            SCENE, "--set", f"{look}/origin={json.dumps(eye)}", "--set", f"{look}/target={json.dumps([spot, 0, 0])}",
            "--set", f"/light/position={json.dumps(lamp)}", "--set", f"/floor/bsdf/alpha={alpha}", "--set", "/sensor/film/width=320", "--set",
            "/sensor/film/height=240", *PHOTON_MAP, "--param", f"photons={study.paper.number('figure2_photons')}",
            "--param", "nearest=100"], f"{name}-alpha{alpha}.exr")
        found.append(f"{bend(Floor(exr.read_layers(file), scene)).index:.2f} at alpha {alpha}")
    return ", ".join(found)


SECTIONS = {"figure2-shape": shape}
