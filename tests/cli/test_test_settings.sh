# tests.yaml: its errors have a place, a reason and a remedy, and nothing runs.
. tests/cli/lib.sh
tool=$(realpath "$LAVARAY")
cd "$work" || exit 1
mkdir -p t/scenes
cp "$OLDPWD/$small" t/scenes/ball.yaml

# wrong LINE:COLUMN PATTERN TEXT...: tests.yaml of these lines is refused there, for this reason.
wrong() {
    local place=$1 pattern=$2
    shift 2
    printf '%s\n' "$@" >t/tests.yaml
    expect 3 "$tool" test t || return
    says err "^t/tests.yaml:$place: $pattern"
    says err '^ +\| +\^$'
}

wrong 1:1 'unknown key "default" in the tests; did you mean "defaults"\?' 'default: {timeout: 3}'
wrong 2:10 'unknown key "sampels" in the case; did you mean "samples"\?' 'cases:' '  ball: {sampels: 3}'
wrong 2:19 'samples is 0, expected a whole number from 1 to 65536' 'cases:' '  ball: {samples: 0}'
wrong 2:16 'size is 640, expected width and height .* such as 640x480' 'cases:' '  ball: {size: 640}'
wrong 1:22 'timeout is soon, expected a number above 0' 'defaults: {timeout:  soon}'
wrong 2:3 'no scene is called "bell"; did you mean "ball"\?' 'cases:' '  bell: {samples: 3}'
wrong 2:3 'no scene is called "tower" in t/scenes, and the case has neither scene nor run' 'cases:' '  tower: {samples: 3}'
wrong 2:3 '"ball" is the name of a scene' 'cases:' '  ball: {scene: scenes/ball.yaml}'
wrong 2:12 'run never says "\{output\}"' 'cases:' '  a: {run: [draw]}'
wrong 2:19 'braces without quotes are a mapping' 'cases:' '  a: {run: [draw, {output}]}'
wrong 2:12 'run is draw.sh, expected a command such as' 'cases:' '  a: {run: draw.sh}'
wrong 2:3 'this cannot be a case.s name' 'cases:' '  ../a: {}'
wrong 2:3 'this cannot be a case.s name' 'cases:' '  /a: {}'
wrong 2:20 'unknown metric "flip-meen"; did you mean "flip-mean"\?' 'cases:' '  ball: {compare: {flip-meen: 0.1}}'
wrong 2:26 'rmse: expected a number' 'cases:' '  ball: {compare: {rmse: little}}'
wrong 2:29 'this rectangle is a list of 3' 'cases:' '  ball: {compare: {ignore: [[1, 2, 3]]}}'
wrong 2:20 'noise needs variances or halves' 'cases:' '  ball: {compare: {noise: 0.1}}'
wrong 2:18 'format is jpg, expected png, exr, pfm, ppm, pgm or hdr' 'cases:' '  ball: {format: jpg}'
wrong 3:3 'duplicate key "ball", first given on line 2' 'cases:' '  ball: {samples: 3}' '  ball: {samples: 4}'
wrong 1:1 'the file holds no tests file, expected keys such as defaults and cases' ''
wrong 2:1 'a tab indents this line' 'cases:' "$(printf '\t')ball: {}"
wrong 2:3 'the case is the text "depth:3", .*put a space after the colon' 'defaults:' '  depth:3'

# docs/test.md has a row or a word for every key, and for none that is no key.
echo 'cases: {ball: {zzzzzz: 1}}' >t/tests.yaml
expect 3 "$tool" test t
keys=$(sed -n 's/.*unknown key "zzzzzz" in the case, expected one of //p' err | tr -d ,)
rows=$(sed -n '/^| key |/,/^$/p' "$OLDPWD/docs/test.md" | awk -F'|' '/`/ { print $2 }' | grep -o '[a-z]*')
[ "$(printf '%s\n' $keys | sort)" = "$(printf '%s\n' $rows | sort)" ] ||
    problem "keys: $(xargs <<<"$keys"); in docs/test.md: $(xargs <<<"$rows")"
for metric in $("$tool" compare --help | sed -n 's/^ *--\([a-z0-9-]*\) [A-Z][A-Z]* .*/\1/p'); do
    case $metric in
    exact | noise | reference-* | test-* | mask | ignore | json) continue ;;
    esac
    echo "cases: {ball: {compare: {$metric: 1}}}" >t/tests.yaml
    expect 0 "$tool" test t --list
    grep -q "\`$metric\`" "$OLDPWD/docs/test.md" || problem "docs/test.md does not know $metric"
done

rm t/tests.yaml
cp t/scenes/ball.yaml t/scenes/ball.yml
expect 5 "$tool" test t && one_line
says err 'two scenes for one case'
rm t/scenes/ball.yml
mkdir t/golden
touch t/golden/ball.png t/golden/ball.exr
expect 5 "$tool" test t && one_line
says err 'two goldens for one case'
rm t/golden/*
touch t/golden/bell.png
expect 0 "$tool" test t --list
says err 'golden/bell.png belongs to no case'
[ "$(cat out)" = ball ] || problem 'not the one scene'
touch t/golden/ball.exr
printf 'cases: {ball: {format: png}}\n' >elsewhere.yaml
expect 0 "$tool" test t --list --settings elsewhere.yaml
says err 'golden/ball.exr belongs to no case'

# A folder without scenes/ holds the scenes itself.
mkdir flat
cp t/scenes/ball.yaml flat
echo 'defaults: {samples: 1}' >flat/tests.yaml
expect 0 "$tool" test flat --list
[ "$(cat out)" = ball ] || problem "cases of a flat folder: $(xargs <out)"

# Links to folders are not followed: they may lead back here.
mkdir -p round/scenes
cp t/scenes/ball.yaml round/scenes
ln -s . round/scenes/here
ln -s .. round/scenes/up
ln -s ball.yaml round/scenes/link.yaml
expect 0 "$tool" test round --list
[ "$(xargs <out)" = 'ball link' ] || problem "cases of a folder with links: $(xargs <out)"

mkdir empty
expect 2 "$tool" test empty && one_line
says err 'no test cases here'
expect 5 "$tool" test nowhere && one_line
expect 5 "$tool" test elsewhere.yaml && one_line
expect 2 "$tool" test && one_line
expect 2 "$tool" test --reference t && one_line
expect 2 "$tool" test t --reference t --candidate t && one_line
expect 2 "$tool" test t flat && one_line
expect 5 "$tool" test t --settings nowhere.yaml && one_line
expect 5 "$tool" test flat --output /proc/nowhere && one_line
for report in --junit --json --report; do
    expect 5 "$tool" test flat $report /proc/nowhere/x && one_line
    expect 5 "$tool" test flat $report t && one_line
done
[ ! -e lavaray-test ] || problem 'something ran'
finish
