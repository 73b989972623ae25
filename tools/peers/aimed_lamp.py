"""What an export to Mitsuba needs for its light tracer: a lamp that is aimed, and a floor that sends next to nothing back."""
import re

DARK = 0.001  # times the floor's reflectance; pictures are divided by it
INDEPENDENT = '<sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>'


def aimed(text, name, origin, target, up, cutoff, beam_width):
    """A spot light of the point light's intensity in its place (angles in degrees; its particles do not go past the scene), over one dark floor."""
    origin, target, up = (", ".join(repr(float(each)) for each in point) for point in (origin, target, up))
    spot = (f'<emitter type="spot">\n    <transform name="to_world"><lookat origin="{origin}" target="{target}" up="{up}"/></transform>\n'
            f'    <float name="cutoff_angle" value="{cutoff!r}"/>\n    <float name="beam_width" value="{beam_width!r}"/>')
    text, lamps = re.subn(r'<emitter type="point">\s*<point name="position"[^>]*/>', spot, text)
    text, floors = re.subn(r'(<rgb name="reflectance" value=")([^"]*)"', darker, text)
    if (lamps, floors) != (1, 1):
        raise ChildProcessError(f"{name}: the export to Mitsuba is not as this tool knows it")
    return text


def independent(text):
    """Without strata: those of Mitsuba, without jitter, give the light paths of all pixels the same numbers."""
    return re.sub(r'<sampler type="stratified">.*?</sampler>', INDEPENDENT, text, flags=re.DOTALL)


def darker(found):
    return f'{found[1]}{" ".join(repr(DARK * float(each)) for each in found[2].split())}"'
