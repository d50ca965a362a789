# The page of `lavaray test --report` in a browser: it says nothing on the console, shows the right
# pictures in each view, and knows the values of a pixel. Skipped without Chromium.
. tests/cli/lib.sh
tool=$(realpath "$LAVARAY")
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
[ -n "$browser" ] || { echo 'no chromium: apt-get install chromium' >&2; exit 77; }
command -v pngtopnm >/dev/null && command -v python3 >/dev/null || { echo 'no netpbm or python3' >&2; exit 77; }
cd "$work" || exit 1

# Pictures of one colour each, which nothing else on the page has.
cat >make.py <<'END'
import os, struct
os.makedirs("reference"); os.makedirs("candidate")
def ppm(path, colors):
    with open(path, "wb") as f:
        f.write(b"P6 40 30 255\n" + b"".join(bytes(colors(x, y)) for y in range(30) for x in range(40)))
def pfm(path, value):
    with open(path, "wb") as f:
        f.write(b"PF\n5 4\n-1.0\n" + struct.pack("<3f", *value) * 20)
def wide(path, value):
    with open(path, "wb") as f:
        f.write(b"P6 5 4 65535\n" + struct.pack(">3H", *value) * 20)
ppm("reference/flat.ppm", lambda x, y: (10, 200, 30))
ppm("candidate/flat.ppm", lambda x, y: (210, 20, 130))
ppm("reference/spot.ppm", lambda x, y: (10, 200, 30))
ppm("candidate/spot.ppm", lambda x, y: (210, 20, 130) if 30 <= x < 36 and 20 <= y < 24 else (10, 200, 30))
ppm("reference/same.ppm", lambda x, y: (1, 2, 3))
ppm("candidate/same.ppm", lambda x, y: (1, 2, 3))
pfm("reference/float.pfm", (0.1, -2.5, 1e6))
pfm("candidate/float.pfm", (0.1, -2.5, 1.5e6))
wide("reference/wide.ppm", (1, 1000, 65535))
wide("candidate/wide.ppm", (2, 1000, 65534))
END
python3 make.py
# A name that would be an element, were it not text.
mv reference/wide.ppm 'reference/<img src=x onerror=console.error(1)>.ppm'
mv candidate/wide.ppm 'candidate/<img src=x onerror=console.error(1)>.ppm'
expect 1 "$tool" test --reference reference --candidate candidate --report page.html

# browse FRAGMENT FLAG...: opens the page; what the browser says is in `log`, the document in `dom`.
browse() {
    local fragment=$1
    shift
    HOME=$work timeout 120 "$browser" --headless=new --no-sandbox --disable-gpu --hide-scrollbars \
        --force-color-profile=srgb --enable-logging=stderr --v=0 --user-data-dir="$work/profile" \
        --virtual-time-budget=3000 "$@" "file://$work/page.html#$fragment" >dom 2>log </dev/null ||
        problem "the browser failed at #$fragment"
    grep 'CONSOLE' log && problem "the console is not silent at #$fragment"
}

# has PATTERN: in the document.
has() {
    tr '\n' ' ' <dom | grep -qE -e "$1" || problem "no /$1/ at #$2"
}

look() {
    browse "$1" --dump-dom --window-size=1280,1000
    has 'data-state="ready"' "$1"
}

look 'case=flat.ppm'
has '4 of 5 cases failed' ''
[ "$(grep -o '<li>' dom | wc -l)" -eq 4 ] || problem 'the list does not hold the four that failed'
has 'aria-current="true"[^>]*><span>flat.ppm' ''
has '1200 of 1200 pixels' ''
look 'case=same.ppm'
[ "$(grep -o '<li>' dom | wc -l)" -eq 5 ] || problem 'the list does not hold all five'
has '--embed-all' 'case=same.ppm'
look 'case=flat.ppm&view=slider&probe=39,29'
has 'data-view="slider"[^>]*aria-pressed="true"|aria-pressed="true"[^>]*data-view="slider"' ''
has 'reference</span><span>10  200  30</span>' ''
has 'candidate</span><span>210  20  130</span>' ''
has 'change</span><span>200  -180  100</span>' ''
look 'case=float.pfm&probe=2,2'
has 'reference</span><span>0.1  -2.5  1000000</span>' ''
has 'change</span><span>0  0  500000</span>' ''
look 'case=%3Cimg+src%3Dx+onerror%3Dconsole.error(1)%3E.ppm&probe=0,3'
has 'reference</span><span>1  1000  65535</span>' ''
has 'change</span><span>1  0  -1</span>' ''
look 'case=spot.ppm&worst'
has '6 × 4 at 30, 20' ''
look 'case=nonsense&view=nonsense&scale=nonsense&at=nonsense&probe=nonsense'

# Flicker shows both in turn.
seen=
for budget in 1000 1500 2000 2500; do
    browse 'case=flat.ppm&view=flicker' --dump-dom --virtual-time-budget=$budget
    seen="$seen $(grep -o 'data-kind="[a-z]*"' dom)"
done
case $seen in
*reference*candidate* | *candidate*reference*) ;;
*) problem "flicker shows$seen" ;;
esac

# A page without cases, as that of an empty shard.
mv page.html full.html
expect 0 "$tool" test --reference reference --candidate candidate --shard 9/9 --report page.html
look ''
has '0 cases, none failed' ''
mv full.html page.html

# share VIEW... : percent of the reference's and of the candidate's colour among both on the screen.
share() {
    browse "$1" --screenshot="$work/shot.png" --window-size="${2:-1280,1000}"
    pngtopnm shot.png 2>/dev/null | python3 -c '
import collections, sys
data = sys.stdin.buffer.read().split(b"\n", 3)[3]
count = collections.Counter(data[i:i + 3] for i in range(0, len(data), 3))
a, b = count[bytes((10, 200, 30))], count[bytes((210, 20, 130))]
print(round(100 * a / (a + b)), round(100 * b / (a + b))) if a + b > 10000 else print("nothing")'
}

# shows FRAGMENT LOW HIGH: the reference's share lies between.
shows() {
    local low=$2 high=$3 got
    got=$(share "$1" "${4:-}")
    case $got in
    nothing) problem "neither picture is to be seen at #$1" ;;
    *) [ "${got% *}" -ge "$low" ] && [ "${got% *}" -le "$high" ] || problem "$got % at #$1, not $low to $high" ;;
    esac
}
for size in 1280,1000 500,1600; do
    shows 'case=flat.ppm&view=reference' 100 100 $size
    shows 'case=flat.ppm&view=candidate' 0 0 $size
    shows 'case=flat.ppm&view=side' 49 51 $size
done
shows 'case=flat.ppm&view=slider&at=50' 48 52
shows 'case=flat.ppm&view=slider&at=50&scale=20&x=20&y=15' 48 52
# The spot is 24 of 1200 pixels; from near it is more of what is to be seen.
shows 'case=spot.ppm&view=candidate' 97 99
shows 'case=spot.ppm&view=candidate&worst' 80 95
finish
