"""A scene of ours as a dictionary of Mitsuba 3's: the part of the scene language that the scenes in
this folder use. What is not known here is an error, so that nothing is left out in silence.

Mitsuba's units: a surface's emission is its radiance in both; a point or directional light of ours
lights a diffuse surface as one of pi times its intensity there. Its max_depth counts edges of a path,
ours the bounces between the first hit and the last that is lit.
"""

import math
import os

import mitsuba as mi
import numpy as np
import yaml

import compensated as _  # registers it, and this
import mixed as _  # noqa: F811


def take(mapping, **defaults):
    """The values of these keys; any other key is an error."""
    unknown = set(mapping) - set(defaults)
    if unknown:
        raise SystemExit("to_mitsuba.py does not know %s in %s" % (sorted(unknown), mapping))
    return [mapping.get(key, default) for key, default in defaults.items()]


def rgb(value):
    return np.array(value if isinstance(value, list) else [value] * 3, dtype=float)


def spectrum(value):
    return {"type": "rgb", "value": [float(x) for x in rgb(value)]}


# ---- Materials


def compensated(inner, white, tint):
    return {"type": "compensated", "inner": inner, "white": white, "tint": mi.ScalarColor3f(*tint)}


def conductor(m):
    _, roughness, eta, k = take(m, model=0, roughness=0, eta=None, k=None)
    base = {"eta": spectrum(eta), "k": spectrum(k)}
    if not roughness:
        return {"type": "conductor", **base}
    rough = {"type": "roughconductor", "distribution": "ggx", "alpha": roughness ** 2}
    eta, k = rgb(eta), rgb(k)
    facing = ((eta - 1) ** 2 + k ** 2) / ((eta + 1) ** 2 + k ** 2)
    return compensated({**rough, **base}, {**rough, "material": "none"}, facing)


def dielectric(m):
    _, roughness, ior = take(m, model=0, roughness=0, ior=1.5)
    if ior == 1:
        return {"type": "null"}
    base = {"int_ior": float(ior), "ext_ior": 1.0}
    if not roughness:
        return {"type": "dielectric", **base}
    rough = {"type": "roughdielectric", "distribution": "ggx", "alpha": roughness ** 2, **base}
    return compensated(rough, rough, (1, 1, 1))


def classic(m):
    color, diffuse, reflect, transmit, ior, fresnel = take(
        m, color=0.8, diffuse=None, reflect=0, transmit=0, ior=1.5, fresnel=False)
    if np.any(rgb(transmit)):
        if not fresnel or transmit != 1 or diffuse != 0:
            raise SystemExit("to_mitsuba.py: of what transmits it knows clear glass alone")
        return dielectric({"ior": ior})
    reflect = rgb(reflect)
    matt = rgb(color) * (1 - reflect if diffuse is None else rgb(diffuse))
    diffuse_bsdf = {"type": "diffuse", "reflectance": spectrum(list(matt))}
    if not np.any(reflect):
        return diffuse_bsdf
    share = reflect.max() / (reflect.max() + matt.max())
    mirror = {"type": "conductor", "material": "none",
              "specular_reflectance": spectrum(list(reflect / share))}
    if share == 1:
        return mirror
    diffuse_bsdf["reflectance"] = spectrum(list(matt / (1 - share)))
    return {"type": "blendbsdf", "weight": share, "matt": diffuse_bsdf, "mirror": mirror}


def mix(m, materials):
    _, first, second, weight = take(m, model=0, first=None, second=None, weight=0.5)
    return {"type": "mixed", "weight": float(weight),
            "first": plain(named(first, materials), materials),
            "second": plain(named(second, materials), materials)}


def named(material_or_name, materials):
    return materials[material_or_name] if isinstance(material_or_name, str) else material_or_name


def plain(m, materials):
    """The BSDF of what does not emit."""
    model = m.get("model", "classic")
    if model == "mix":
        return mix(m, materials)
    return {"classic": classic, "conductor": conductor, "dielectric": dielectric}[model](m)


def medium(m):
    """What fills the inside or the air, taken out of the mapping m; None: nothing."""
    absorption, scattering, g = (m.pop(key, 0) for key in ("absorption", "scattering", "anisotropy"))
    rate = rgb(absorption) + rgb(scattering)
    if not np.any(rate):
        return None
    albedo = np.divide(rgb(scattering), rate, out=np.zeros(3), where=rate > 0)
    # Mitsuba's colours are at most 1.
    return {"type": "homogeneous", "sigma_t": spectrum(list(rate / rate.max())), "scale": float(rate.max()),
            "albedo": spectrum(list(albedo)), "phase": {"type": "hg", "g": float(g)}}


def material(m, materials):
    """The BSDF, and the emitter and the medium inside or None. Ours have two sides; what emits is black from behind."""
    m = dict(m)
    emission, emits = m.pop("emission", 0), m.pop("emits", "both")
    inside = medium(m)
    bsdf = plain(m, materials)
    if not np.any(rgb(emission)):
        kind = bsdf.get("inner", bsdf)["type"]
        transmits = "dielectric" in kind or kind == "null"
        return bsdf if transmits else {"type": "twosided", "bsdf": bsdf}, None, inside
    if emits != "front":
        raise SystemExit("to_mitsuba.py: Mitsuba's lamps shine to the front alone")
    return bsdf, {"type": "area", "radiance": spectrum(emission)}, inside


# ---- Shapes

def matrix(columns, origin):
    m = np.eye(4)
    m[:3, :3] = np.array(columns, dtype=float).T
    m[:3, 3] = origin
    return mi.ScalarTransform4f(m)


def placement(scale, rotate, translate):
    t = mi.ScalarTransform4f().translate(translate)
    for axis, angle in reversed(list(zip(np.eye(3), rotate))):
        t = t @ mi.ScalarTransform4f().rotate(list(axis), float(angle))
    return t @ mi.ScalarTransform4f().scale(list(rgb(scale)))


def rectangle(corner, u, v):
    corner, u, v = np.array(corner, float), np.array(u, float), np.array(v, float)
    n = np.cross(u, v)
    return {"type": "rectangle",
            "to_world": matrix([u / 2, v / 2, n / np.linalg.norm(n)], corner + (u + v) / 2)}


def disk(center=(0, 0, 0), normal=(0, 1, 0), radius=1):
    n = np.array(normal, float) / np.linalg.norm(normal)
    x = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    x /= np.linalg.norm(x)
    return {"type": "disk", "to_world": matrix([radius * x, radius * np.cross(n, x), n], center)}


def box(min, max):  # pylint: disable=redefined-builtin
    low, high = np.array(min, float), np.array(max, float)
    return {"type": "cube", "to_world": matrix(np.diag((high - low) / 2), (high + low) / 2)}


def sphere(center=(0, 0, 0), radius=1):
    return {"type": "sphere", "center": [float(x) for x in center], "radius": float(radius)}


def mesh(file):
    return {"type": "ply", "filename": file, "face_normals": True}


SHAPES = {"rectangle": rectangle, "disk": disk, "box": box, "sphere": sphere, "mesh": mesh}


def shape(kind, o, materials, folder):
    o = dict(o)
    name = o.pop("material", {})
    bsdf, emitter, inside = material(named(name, materials), materials)
    moved = placement(o.pop("scale", 1), o.pop("rotate", [0, 0, 0]), o.pop("translate", [0, 0, 0]))
    if "file" in o:
        o["file"] = os.path.join(folder, o["file"])
    result = SHAPES[kind](**o)
    result["to_world"] = moved @ result.get("to_world", mi.ScalarTransform4f())
    result["bsdf"] = bsdf
    if inside:
        result["interior"] = inside
    if emitter:
        result["emitter"] = emitter
    return result


# ---- Lights

def point(position, intensity=1, color=1):
    return {"type": "point", "position": position,
            "intensity": spectrum(list(math.pi * intensity * rgb(color)))}


def directional(direction, intensity=1, color=1):
    return {"type": "directional", "direction": direction,
            "irradiance": spectrum(list(math.pi * intensity * rgb(color)))}


LIGHTS = {"point": point, "directional": directional}

# Mitsuba's grid of a picture begins and ends on the poles, ours has texels with areas. This many
# points for each texel make the difference small.
FINER = 16


def finer(picture):
    """The picture blended between the centres of its texels, as ours is, on a finer grid."""
    height, width, _ = picture.shape
    x = (np.arange(width * FINER) + 0.5) / FINER - 0.5
    y = np.clip(np.arange(height * FINER + 1) / FINER - 0.5, 0, height - 1)
    x0, y0 = np.floor(x).astype(int), np.minimum(np.floor(y).astype(int), height - 2)
    fx, fy = (x - x0)[None, :, None], (y - y0)[:, None, None]
    rows = picture[:, x0 % width] * (1 - fx) + picture[:, (x0 + 1) % width] * fx
    return rows[y0] * (1 - fy) + rows[y0 + 1] * fy


def background(value, folder):
    if not isinstance(value, dict):
        return {"type": "constant", "radiance": spectrum(value)}
    (name,) = take(value, image=None)
    picture = np.array(mi.Bitmap(os.path.join(folder, name)).convert(
        mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False), dtype=float)
    # The middle of ours is where -z is, where Mitsuba's begins.
    turned = np.roll(finer(picture), -FINER * picture.shape[1] // 2, axis=1)
    return {"type": "envmap", "bitmap": mi.Bitmap(turned.astype(np.float32))}


# ---- The whole

def choose_by_power(shapes):
    """Mitsuba chooses lights at random; so that bright ones are chosen more often, which changes the
    noise alone."""
    powers = []
    for s in shapes:
        bare = mi.load_dict({key: value for key, value in s.items() if key not in ("emitter", "exterior")})
        area = float(np.ravel(bare.surface_area())[0])
        powers.append(area * max(s["emitter"]["radiance"]["value"]))
    for s, power in zip(shapes, powers):
        s["emitter"]["sampling_weight"] = power / np.mean(powers)


def sensor(camera, width, height):
    origin, target, fov, aperture, focus = take(
        camera, **{"from": [0, 1, 5], "to": [0, 0, 0], "fov": 40, "aperture": 0, "focus": 0})
    result = {
        "type": "thinlens" if aperture else "perspective", "fov": float(fov), "fov_axis": "y",
        "to_world": mi.ScalarTransform4f().look_at(origin, target, [0, 1, 0]),
        "film": {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb",
                 "component_format": "float32", "rfilter": {"type": "box"}}}
    if aperture:
        result.update(aperture_radius=float(aperture) / 2, focus_distance=float(focus))
    return result


def fill_air(scene, air):
    """The same medium outside of all objects and around the camera."""
    scene["air"] = air
    scene["sensor"]["medium"] = {"type": "ref", "id": "air"}
    for name, item in scene.items():
        if name.startswith("object"):
            item["exterior"] = {"type": "ref", "id": "air"}


def load(path, size=None):
    """The scene file at path, with another width and height if size is given."""
    with open(path, encoding="utf-8") as file:
        scene = yaml.safe_load(file)
    folder = os.path.dirname(path)
    camera, image, around, materials, lights, objects, air = take(
        scene, camera=None, image=None, background=0, materials={}, lights=None, objects=None, air=None)
    width, height, _, depth, _ = take(image, width=640, height=480, samples=1, depth=6, integrator="path")
    result = {"type": "scene", "integrator": {"type": "path", "max_depth": depth + 2},
              "sensor": sensor(camera, *(size or (width, height)))}
    if isinstance(around, dict) or np.any(rgb(around)):
        result["background"] = background(around, folder)
    for i, item in enumerate(lights):
        ((kind, light),) = item.items()
        result["light%d" % i] = LIGHTS[kind](**light)
    for i, item in enumerate(objects):
        ((kind, o),) = item.items()
        result["object%d" % i] = shape(kind, o, materials, folder)
    if air:
        fill_air(result, medium(dict(air)))
    if air or any("interior" in s for s in result.values() if isinstance(s, dict)):
        result["integrator"]["type"] = "volpath"
    choose_by_power([s for s in result.values() if "emitter" in s])
    return result
