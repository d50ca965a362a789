# An independent judge: POV-Ray renders the same scene, and 99.9 % of the pixels agree within 1/255
# of full scale, linear. Skipped where POV-Ray or netpbm is not installed.
set -u
command -v povray >/dev/null && command -v pngtopnm >/dev/null || { echo 'no povray or netpbm' >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
folder=tests/images/povray
"$LAVARAY" render $folder/judge.yaml -q --transfer linear --maxval 65535 -o "$work/ours.ppm" || exit 1
povray +I$folder/judge.pov +O"$work/theirs.png" +W320 +H240 -D -A +FN16 File_Gamma=1.0 \
    >"$work/povray.log" 2>&1 || { tail -n 20 "$work/povray.log" >&2; exit 1; }
pngtopnm "$work/theirs.png" >"$work/theirs.ppm" 2>"$work/netpbm.log" || exit 1
share=$(python3 $folder/compare.py "$work/ours.ppm" "$work/theirs.ppm") || exit 1
echo "$share % of the pixels agree within 1/255"
awk "BEGIN { exit !($share >= 99.9) }"
