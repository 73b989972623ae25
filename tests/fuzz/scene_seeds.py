"""Scenes for the fuzzer that each take another way through the readers: what they know, and what they refuse."""
import copy
import json

BASE = {
    "type": "scene", "version": 1,
    "camera": {"type": "perspective", "fov": 40,
               "to_world": [{"look_at": {"origin": [0, -4, 2], "target": [0, 0, 0], "up": [0, 0, 1]}}],
               "film": {"type": "hdrfilm", "width": 4, "height": 4},
               "sampler": {"type": "independent", "sample_count": 1}},
    "lamp": {"type": "point", "position": [1, 0, 3], "intensity": 10},
    "floor": {"type": "rectangle", "to_world": [{"scale": 2}, {"translate": [0, 0, -1]}],
              "bsdf": {"type": "diffuse", "reflectance": 0.5}},
    "ball": {"type": "sphere", "radius": 0.5, "bsdf": {"type": "conductor", "material": "none"}}}

GREY = {"type": "diffuse", "reflectance": 0.5}
MIRROR = {"type": "conductor", "material": "none"}
GLASS = {"type": "dielectric", "int_ior": "bk7", "ext_ior": "air"}
BITMAP = {"type": "bitmap", "filename": "texture.png"}
SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]

# Where -> what stands there, one scene each. A value of ... takes the key away.
VALUES = {
    "/type": ["sweep"], "/version": [2], "/extra": [1, {"type": "path"}, {"type": "area"}, {"type": "envmap"},
                                                    {"type": "diffuse"}, {"type": "teapot"}, {}],
    "/camera": [..., GREY], "/ball": [...], "/second": [copy.deepcopy(BASE["camera"])],
    "/camera/type": ["thinlens"], "/camera/fov": [0, 1e-7, 179.99995, 181, "x"],
    "/camera/fov_axis": ["x", "y", "diagonal", "smaller", "larger", "z"],
    "/camera/to_world": [[{"scale": [1, 2, 1]}], [{"scale": [-1, 1, 1]}], [{"translate": [1e20, 0, 0]}], [{"scale": 3}]],
    "/camera/film/width": [65536, 65537], "/camera/film": [{"type": "hdrfilm", "width": 65536, "height": 65536}],
    "/camera/film/filter": [{"type": "box"}, {"type": "gaussian"}, {"type": "x"}, {"type": "box", "y": 1}],
    "/camera/again": [{"type": "hdrfilm"}, {"type": "independent"}, {"type": "ldsampler"}],
    "/camera/sampler": [
        {"type": "stratified", "sample_count": 4, "jitter": False}, {"type": "stratified", "sample_count": 5},
        {"type": "adaptive", "sample_count": 4, "max_sample_count": 8, "max_error": 0.1},
        {"type": "adaptive", "sample_count": 1}, {"type": "adaptive", "sample_count": 8, "max_sample_count": 4},
        {"type": "adaptive", "sample_count": 4, "max_error": 0}, {"type": "independent", "split_depth": 1}],
    "/lamp": [
        {"type": "point", "to_world": [{"translate": [1, 0, 3]}]},
        {"type": "point", "position": [0, 0, 3], "to_world": []}, {"type": "point", "position": [1e19, 0, 0]},
        {"type": "spot", "to_world": [{"look_at": {"origin": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0]}}],
         "cutoff_angle": 100, "beam_width": 20, "intensity": [1, 2, 3]},
        {"type": "spot", "cutoff_angle": 20, "to_world": [{"rotate": {"axis": [1, 0, 0], "angle": 180}}, {"translate": [0, 0, 3]}]},
        {"type": "spot", "cutoff_angle": 20, "beam_width": 30}, {"type": "spot", "cutoff_angle": 180},
        {"type": "directional", "direction": [0, 0.5, -1], "irradiance": 1e-31},
        {"type": "directional", "direction": [0, 0.5, -1], "irradiance": {"type": "rgb", "value": [1, 0, 2]}},
        {"type": "directional", "to_world": [{"rotate": {"axis": [1, 0, 0], "angle": 180}}]},
        {"type": "directional", "direction": [0, 0, 0]}, {"type": "directional", "direction": [0, 0, 1], "to_world": []},
        {"type": "constant", "radiance": 2}, {"type": "ambient", "radiance": [1, 1e-40, 0]},
        {"type": "ambient", "radiance": {"type": "rgb", "value": 1}}, {"type": "ambient", "radiance": {"type": "d65"}},
        {"type": "point", "intensity": [1, 2]}],
    "/sky": [{"type": "constant"}, {"type": "ambient"}], "/sky2": [{"type": "constant"}],
    "/floor/to_world": [
        [{"look_at": {"origin": [0, 0, 0], "target": [0, 0, 1], "up": [0, 0, 1]}}],
        [{"rotate": {"axis": [0, 0, 0], "angle": 1}}], [{"rotate": {"axis": [1, 1, 0], "angle": 30}}],
        [{"translate": [0, 0, 1], "scale": 2}], [{}], [{"scale": [1, 1, 0]}], [{"scale": 1e31}],
        [{"scale": 1e20}, {"scale": 1e20}], [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0, 0, 1],
        [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -1], [0, 0, 0, 1]], [1, 0, 0], [1] * 16, 5,
        [{"scale": 1e-9}], [{"scale": 1e-3}, {"translate": [1e5, 0, 0]}], [{"scale": [1e-30, 1, 1]}],
        [{"translate": [1e12, 0, 0]}]],
    "/floor/flip_normals": [True, 1], "/floor/face_normals": [True], "/floor/nothing": [1],
    "/floor/resolution": [3, [2, 3], [2], "x", 5000], "/ball/resolution": [4, 1], "/ball/face_normals": [True],
    "/ball/to_world": [[{"scale": [1, 2, 1]}]], "/ball/radius": [0, -1, 1e-12], "/ball/center": [[0, 0, 1], [0, 1]],
    "/floor/light": [{"type": "area", "radiance": 2}, {"type": "area", "x": 1}, {"type": "homogeneous"}, {"type": "y"}],
    "/floor/zz": [GREY], "/ball/lamp": [{"type": "area"}],
    "/floor/bsdf/reflectance": [
        2, "x", [0.1, 0.2], {"type": "rgb", "value": [0.1, 0.2, 0.3]}, {"type": "spectrum"},
        {"type": "checkerboard", "color0": 0.1, "color1": [0.2, 0.3, 0.4], "to_uv": [{"scale": [4, 4, 1]}]}, BITMAP,
        {**BITMAP, "raw": True, "filter_type": "nearest", "wrap_mode": "mirror", "to_uv": [{"scale": [3, 3, 1]}]},
        {**BITMAP, "wrap_mode": "clamp", "to_uv": [{"translate": [-5, 5, 0]}]},
        {**BITMAP, "filename": "heights.exr", "raw": True}, {**BITMAP, "filename": "bright.exr"},
        {**BITMAP, "filename": "."}, {**BITMAP, "filename": "part.json"}],
    "/floor/bsdf": [
        {"type": "phong", "exponent": 20, "specular_reflectance": 0.3, "diffuse_reflectance": 0.3, "model": "classic"},
        {"type": "phong", "specular_reflectance": 0.8, "diffuse_reflectance": 0.8},
        {"type": "phong", "diffuse_reflectance": BITMAP}, {"type": "schlick", "specular_reflectance": 0.3, "alpha": 0.2},
        {"type": "schlick", "alpha": 0}, {"type": "schlick", "roughness": 0.2, "isotropy": 0.5}, {"type": "principled"},
        {"type": "blendbsdf", "weight": 0.25, "a": GREY, "b": MIRROR}, {"type": "blendbsdf", "weight": 0, "a": GREY, "b": MIRROR},
        {"type": "blendbsdf", "weight": 1, "a": MIRROR, "b": GREY}, {"type": "blendbsdf", "weight": 0, "a": MIRROR, "b": GREY},
        {"type": "blendbsdf", "weight": BITMAP, "a": GREY, "b": MIRROR}, {"type": "blendbsdf", "a": GREY},
        {"type": "blendbsdf", "a": GREY, "b": GREY}, {"type": "twosided", "a": GREY}, {"type": "twosided", "a": GREY, "b": GREY},
        {"type": "twosided", "a": GLASS}, {"type": "twosided", "a": {"type": "blendbsdf", "a": GREY, "b": MIRROR}},
        {"$include": "part.json"}, {"$include": "part.json", "x": 1}, {"$include": 5}, {"$include": ""},
        {"$include": "loop.json"}, {"$include": "deep0.json"}, {"$include": "none.json"}, {"$include": "."},
        {"$include": "bad.json"}, {"type": "diffuse", "reflectance": {"$include": "odd.json"}}],
    "/ball/bsdf": [
        GLASS, {**MIRROR, "material": "Au"}, {**MIRROR, "material": 1}, {**MIRROR, "specular_reflectance": [0.9, 0.8, 0.7]},
        *({**GLASS, "int_ior": ior} for ior in (
            1.5, 0.01, "glass", True, {"type": "cauchy", "A": 1.5, "B": 0.004}, {"type": "cauchy", "A": 0.1, "B": 0},
            {"type": "sellmeier", "material": "BK7"}, {"type": "sellmeier", "material": "x"},
            {"type": "sellmeier", "material": "bk7", "B": [1]}, {"type": "sellmeier", "B": [1, 0.2], "C": [0.01, 0.02]},
            {"type": "sellmeier", "B": [], "C": []}, {"type": "sellmeier", "B": [1], "C": [0.25]},
            {"type": "abbe", "n_d": 1.5, "V_d": 60}, {"type": "abbe", "n_d": 1.5, "V_d": 0},
            {"type": "abbe", "n_d": 1.5, "V_d": 60, "x": 1}, {"type": "x"})),
        {**GLASS, "absorption": [1, 2, 3], "specular_transmittance": 0.9, "specular_reflectance": 0.5}],
    "/thing": [
        {"type": "disk", "bsdf": GREY, "light": {"type": "area"}}, {"type": "disk", "resolution": 3},
        {"type": "cylinder", "p0": [0, 0, 0], "p1": [0, 1, 1], "radius": 0.2, "bsdf": MIRROR},
        {"type": "cylinder", "p0": [0, 0, 0], "p1": [0, 0, 0]}, {"type": "cylinder", "resolution": 3},
        {"type": "cube", "resolution": 2, "face_normals": True, "bsdf": GLASS}, {"type": "cube"}, {"type": "instance"},
        {"type": "ply", "filename": "mesh.ply", "flip_normals": True}, {"type": "obj", "filename": "mesh.obj", "face_normals": True},
        {"type": "ply", "filename": "mesh.obj"}, {"type": "obj", "filename": "mesh.obj", "resolution": 4},
        {"type": "ply", "filename": "bad.ply"}, {"type": "ply", "filename": "mesh.ply", "to_world": [{"scale": 1e15}]},
        {"type": "heightfield", "waves": [{"amplitude": 0.1, "wave_vector": [3, 4], "phase": 1}], "half_size": [2, 1], "bsdf": GLASS},
        {"type": "heightfield", "waves": [{"amplitude": 0.1, "wave_vector": [3, 4]}], "resolution": [4, 5], "light": {"type": "area"}},
        {"type": "heightfield", "waves": [{"amplitude": 0.1, "wave_vector": [3, 4]}], "light": {"type": "area"}},
        {"type": "heightfield", "waves": [{"amplitude": 0.1, "wave_vector": [1e30, 4]}]},
        {"type": "heightfield", "waves": [{"amplitude": 0.1, "wave_vector": [1e31, 4]}]},
        {"type": "heightfield", "waves": []}, {"type": "heightfield"}, {"type": "heightfield", "waves": [], "height": 2},
        {"type": "heightfield", "waves": [], "half_size": [0, 1]},
        {"type": "heightfield", "fractal": {"levels": 3, "rms": 0.1, "hurst": 0.5, "lowest": 2, "seed": 7}, "face_normals": True},
        {"type": "heightfield", "fractal": {"levels": 2, "rms": 1e30}, "resolution": 4},
        {"type": "heightfield", "fractal": {"levels": 2, "rms": 0}},
        {"type": "heightfield", "filename": "heights.exr", "height": 0.5}, {"type": "heightfield", "filename": "texture.png"},
        {"type": "heightfield", "filename": "grey8.png"}, {"type": "heightfield", "filename": "grey16.png"},
        {"type": "heightfield", "filename": "row.exr"}, {"type": "heightfield", "filename": "bright.exr", "height": 1e30},
        {"type": "lathe", "profile": [[0, 0], {"at": [1, 0], "crease": True}, [1, 1], [0, 1]], "resolution": 5},
        {"type": "lathe", "profile": [[0, 0], [1, 0.2], [0, 1]], "interpolation": "catmullrom", "segments": 3},
        {"type": "lathe", "profile": [[0.5, 0], [1, 1]], "open": True}, {"type": "lathe", "profile": [[0.5, 0], [1, 1]]},
        {"type": "lathe", "profile": [[1, 0], [2, 0], [2, 1], [1, 0]], "resolution": 3},
        *({"type": "lathe", "resolution": 3, "profile": points} for points in (
            [[1, 0]], [[-1, 0], [1, 1]], [[1, 0], [1, 0]], [[0, 0], [1, 1], [0, 2], [1, 3], [0, 4]], [[0, 0], [0, 1]],
            [[0, 0], [1, 1], [0, 0]], [[0, 0], [2, 0], [2, 2], [1, 2], [1, -1], [0, -1]],
            [[0, 0], [2, 0], [1, 0], [0, 1]], [[1e31, 0], [1, 1]])),
        {"type": "lathe", "interpolation": "catmullrom", "resolution": 3, "profile": [[0, 0], [0.01, 5], [5, 5], [0.01, 6], [0, 9]]},
        {"type": "lathe", "segments": 16, "resolution": 3, "profile": [[0, 0]] + [[1, i] for i in range(300)] + [[0, 300]]},
        {"type": "cut", "rings": [{"count": 6, "angle": 0, "distance": 1, "phase": 0.5}, {"count": 6, "angle": 45, "distance": 1},
                                  {"count": 1, "angle": -90, "distance": 0.5}], "height": 0.9, "bsdf": GLASS},
        {"type": "cut", "planes": [[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1]]},
        {"type": "cut", "planes": [[0, 0, 0, 1]]}, {"type": "cut", "planes": [[1e-20, 0, 0, 1e20]]}, {"type": "cut", "planes": [[1, 0, 0, 1]]},
        {"type": "cut"}, {"type": "cut", "planes": [[0, 0, 1, 1]] * 201}, {"type": "cut", "rings": [{"count": 200, "angle": 0, "distance": 1}] * 2},
        {"type": "cut", "rings": [{"count": 4, "angle": 0, "distance": -1}, {"count": 1, "angle": 90, "distance": 1}]},
        *({"type": "cut", "rings": [{"count": 8, "angle": 0, "distance": 1}, {"count": 1, "angle": -90, "distance": 0}],
           "resolution": 6, **more} for more in (
               {}, {"height": 1, "inner": {"profile": [[0, 0.2], [0.8, 1]]}}, {"height": 1}, {"height": -5}, {"height": 50}, {"inner": {"profile": [[0.8, 1], [0, 0.2]]}},
               {"height": 1, "inner": {"profile": [[0.8, 1], [0.7, 0.5], [0, 0.2]], "interpolation": "catmullrom"}},
               {"height": 1, "inner": {"profile": [[0.8, 1], [0, -0.2]]}}, {"height": 1, "inner": {"profile": [[0.8, 1], [0.5, 0.2]]}},
               {"height": 1, "inner": {"profile": [[0.8, 0.9], [0, 0.2]]}}, {"height": 1, "inner": {"profile": [[2, 1], [0, 0.2]]}},
               {"height": 1, "inner": {"profile": [[0.8, 1], [0, 0.2]], "x": 1}}))],
}


def placed(pointer, value):
    """The base with a value at a pointer."""
    scene = copy.deepcopy(BASE)
    *way, last = pointer[1:].split("/")
    at = scene
    for key in way:
        at = at[key]
    if value is ...:
        del at[last]
    else:
        at[last] = value
    return scene


def variants():
    """Pairs of name and bytes."""
    for pointer, values in VALUES.items():
        for i, value in enumerate(values):
            yield f"{pointer[1:].replace('/', '-')}-{i}", json.dumps(placed(pointer, value)).encode()
    text = json.dumps(BASE)
    yield "twice", text.replace('"fov": 40', '"fov": 40, "fov": 41').encode()
    yield "control", text.replace("sphere", "sph\\u0001ere").encode()
    yield "deep", text.replace("40", "[" * 70 + "]" * 70).encode()
    yield "cut-short", text[:-9].encode()
    yield "nul", text.encode() + b"\x00"
    yield "long", text.replace('"none"', '"' + "ü" * 80 + '"').encode()
    yield "key", text.replace('"lamp"', '"la/m~p"').replace("[1, 0, 3]", "[1, 0]").encode()
