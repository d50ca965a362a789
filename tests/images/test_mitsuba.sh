# An independent judge: Mitsuba 3 has rendered the same scenes (mitsuba/render_references.py), and our
# paths have the same mean, per channel and pixel by pixel, as far as the noise of both tells.
set -u
"$LAVARAY" doctor >/dev/null 2>&1 || { echo 'no usable Vulkan device' >&2; exit 77; }
scenes=(cornell environment glass gold lamps many_lights milk mist mix rough_glass shining thin_lens)
PYTHONDONTWRITEBYTECODE=1 timeout 550 python3 tests/images/mitsuba/judge.py "$LAVARAY" "${scenes[@]}"
