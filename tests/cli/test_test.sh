# `lavaray test`: cases that are commands, so that no device is needed.
. tests/cli/lib.sh
tool=$(realpath "$LAVARAY")
cd "$work" || exit 1

# picture FILE VALUE: a grey of 4 x 3 pixels but for the last one, which is VALUE.
picture() {
    mkdir -p "$(dirname "$1")"
    { echo 'P2 4 3 255'; for _ in 1 2 3 4 5 6 7 8 9 10 11; do echo 100; done; echo "$2"; } >"$1"
}

# tests LINE...: a folder `t` with these lines in tests.yaml.
tests() {
    rm -rf t lavaray-test
    mkdir t
    printf '%s\n' "$@" >t/tests.yaml
}

# case_of NAME: a line for tests.yaml: a case that copies pictures/NAME.pgm.
case_of() {
    echo "  $1: {run: [cp, pictures/$1.pgm, \"{output}\"], format: pgm}"
}

# outcome NAME: of the last run with --json out.json.
outcome() {
    python3 -c 'import json, sys
for case in json.load(open("out.json"))["cases"]:
    if case["name"] == sys.argv[1]:
        print(case["outcome"])' "$1"
}

# is NAME OUTCOME
is() {
    local got
    got=$(outcome "$1")
    [ "$got" = "$2" ] || problem "$1 is $got, not $2"
}

for name in one two three four five; do
    picture "pictures/$name.pgm" 100
done
five=$(for name in one two three four five; do case_of $name; done)

# Missing goldens fail, keep their candidates, and are written by --update-missing alone.
tests cases: "$five"
expect 1 "$tool" test t --json out.json
is one missing
says out '^missing +one'
says out 'lavaray test t -k five --update$'
says out 'lavaray test t --update-missing$'
same lavaray-test/candidate/one.pgm pictures/one.pgm
[ ! -e t/golden ] || problem 'goldens were written without being asked for'
expect 1 "$tool" test t --ci
[ ! -e t/golden ] || problem 'goldens were written with --ci'
for flag in --update --update-missing; do
    expect 2 "$tool" test t --ci $flag && one_line
done
expect 0 "$tool" test t --update-missing --json out.json
is one added
same t/golden/one.pgm pictures/one.pgm
[ ! -e lavaray-test ] || problem 'something was left after nothing failed'
expect 0 "$tool" test t
says out '^5 passed in '

# A difference: one of 255 in one pixel. --update-missing leaves it, --update replaces it alone.
picture pictures/two.pgm 101
picture pictures/three.pgm 100
cp -p t/golden/three.pgm three.pgm
expect 1 "$tool" test t --json out.json
is one passed
is two differs
says out '1 of 12 pixels differ'
same lavaray-test/candidate/two.pgm pictures/two.pgm
[ ! -e lavaray-test/candidate/one.pgm ] || problem 'the candidate of a passing case was kept'
[ -s lavaray-test/difference/two.png ] || problem 'no heat map'
expect 1 "$tool" test t --update-missing --json out.json
is two differs
expect 0 "$tool" test t --update --json out.json
is two updated
is three passed
same t/golden/two.pgm pictures/two.pgm
[ t/golden/three.pgm -nt three.pgm ] && problem 'a golden that did not differ was written again'
expect 0 "$tool" test t
[ ! -e lavaray-test ] || problem 'what an earlier run had left is still there'

# A golden that cannot be read fails, and --update replaces it.
echo rubbish >t/golden/one.pgm
expect 1 "$tool" test t --json out.json
is one broken
expect 0 "$tool" test t --update
same t/golden/one.pgm pictures/one.pgm
# The picture that cannot be read never becomes a golden.
echo rubbish >pictures/one.pgm
expect 1 "$tool" test t --update
says out 'not a picture'
grep -q P2 t/golden/one.pgm || problem 'a golden was replaced by rubbish'
picture pictures/one.pgm 100

# The folder that we are in, also as one of two.
(cd t && "$tool" test . --list && cd golden && "$tool" test --reference . --candidate . --list) >out
[ "$(xargs <out)" = 'five four one three two five.pgm four.pgm one.pgm three.pgm two.pgm' ] ||
    problem "in the folder itself there are $(xargs <out)"

# Selecting cases.
expect 0 "$tool" test t -k two --list
[ "$(cat out)" = two ] || problem 'the name selects more than its case'
expect 0 "$tool" test t -k 'f*' --list
[ "$(xargs <out)" = 'five four' ] || problem "f* selects $(xargs <out)"
expect 0 "$tool" test t -k o --list
[ "$(xargs <out)" = 'four one two' ] || problem "o selects $(xargs <out)"
expect 2 "$tool" test t -k nothing && one_line
for shards in 1 2 3 7; do
    : >all
    for ((i = 1; i <= shards; i++)); do
        expect 0 "$tool" test t --shard $i/$shards --list
        cat out >>all
    done
    [ "$(sort all | xargs)" = 'five four one three two' ] || problem "$shards shards hold: $(xargs <all)"
done
for bad in 0/2 3/2 1 1/0 x/2 1/2x; do
    expect 2 "$tool" test t --shard $bad && one_line
done

# A length of sleep that no other process has.
nap=1000.$$

# Commands that do not do what they should: each fails its own case.
tests 'cases:' "$(case_of one)" \
    '  crash: {run: [sh, -c, "echo the last words; kill -SEGV $$", "{output}"]}' \
    '  hang: {run: [sh, -c, "sleep '"$nap & sleep $nap"'", "{output}"], timeout: 0.5}' \
    '  stubborn: {run: [sh, -c, "trap : TERM; while :; do sleep 1; done", "{output}"], timeout: 0.2}' \
    '  fails: {run: [sh, -c, "echo sorry >&2; exit 7", "{output}"]}' \
    '  leaves: {run: [sh, -c, "sleep '"$nap"' & cp pictures/one.pgm $0", "{output}"], format: pgm}' \
    '  silent: {run: ["true", "{output}"]}' \
    '  folder: {run: [mkdir, "{output}"]}' \
    '  pipe: {run: [mkfifo, "{output}"]}' \
    '  half: {run: [sh, -c, "printf P2 >$0; kill $$", "{output}"]}' \
    '  absent: {run: [./no-such-program, "{output}"]}'
mkdir t/golden
cp pictures/one.pgm t/golden
cp pictures/one.pgm t/golden/leaves.pgm
expect 1 timeout 60 "$tool" test t --jobs 8 --json out.json
is one passed
is leaves passed
for name in crash hang stubborn fails silent folder pipe half absent; do
    is $name broken
done
says out 'ended by signal 11 \(Segmentation fault\)'
says out '\| the last words'
says out 'ended after the time limit of 0.5 s'
says out 'exit code 7'
says out '\| sorry'
says out 'wrote no picture'
says out 'cannot start ./no-such-program: No such file or directory'
[ ! -e lavaray-test ] || problem "left behind: $(find lavaray-test -type f)"
pgrep -f "sleep $nap" >/dev/null && problem 'a command, or what it started, was left running'
expect 1 "$tool" test t --update -k fails
[ ! -e t/golden/fails.png ] || problem 'a command that failed gave a golden'

# --fail-fast: the first that fails is the last to be started.
expect 1 "$tool" test t --fail-fast --jobs 1 --json out.json
is absent broken
is one 'not run'

# As many at a time as --jobs says.
tests 'defaults: {run: [sh, -c, "echo >>running; sleep 0.4; wc -l <running >>most; sed -i 1d running; cp pictures/one.pgm $0", "{output}"], format: pgm}' \
    'cases: {a: , b: , c: , d: }'
mkdir t/golden
for name in a b c d; do
    cp pictures/one.pgm t/golden/$name.pgm
done
expect 0 "$tool" test t --jobs 4
[ "$(sort -n most | tail -n 1)" -gt 1 ] || problem '--jobs 4 ran one at a time'
: >most
: >running
expect 0 "$tool" test t --jobs 1
[ "$(sort -n most | tail -n 1)" -eq 1 ] || problem '--jobs 1 ran several at a time'

# {name} and the metrics of a case.
tests 'defaults: {run: [cp, "pictures/{name}.pgm", "{output}"], format: pgm}' \
    'cases:' '  one: {compare: {abs: 0.005}}' '  two: {compare: {abs: 0.003}}' \
    '  three: {compare: {abs: 0.003, abs-percent: 10}}' '  four: {compare: {ignore: [[3, 2, 1, 1]]}}' \
    '  five: {compare: {mask: mask.pgm}}'
{ echo 'P2 4 3 1'; yes 1 | head -n 11; echo 0; } >t/mask.pgm
for name in one two three four five; do
    picture pictures/$name.pgm 100
    picture t/golden/$name.pgm 101
done
expect 1 "$tool" test t --json out.json
is two differs
for name in one three four five; do
    is $name passed
done

# Two folders.
rm -rf reference candidate lavaray-test
picture reference/same.pgm 1
picture candidate/same.pgm 1
picture reference/below/other.pgm 1
picture candidate/below/other.pgm 2
picture reference/gone.pgm 1
picture candidate/new.pgm 1
expect 1 "$tool" test --reference reference --candidate candidate --json out.json
is same.pgm passed
is below/other.pgm differs
is gone.pgm broken
is new.pgm missing
says out 'lavaray test --reference reference --candidate candidate -k below/other.pgm --update'
[ -s lavaray-test/difference/below/other.pgm.png ] || problem 'no heat map'
expect 0 "$tool" test --reference reference --candidate candidate -k below/other.pgm --update
same reference/below/other.pgm candidate/below/other.pgm
[ ! -e reference/new.pgm ] || problem 'a case was accepted that was not asked for'

# The comparison is a process of its own: it ends by a signal or its time limit without the others.
rm -rf reference candidate
for folder in reference candidate; do
    picture $folder/quick.pgm 1
    { printf 'P5 4000 4000 255\n'; head -c 16000000 /dev/zero | tr '\0' $folder; } >$folder/slow.pgm
done
echo 'cases: {slow.pgm: {compare: {flip-mean: 1}}}' >slow.yaml
"$tool" test --reference reference --candidate candidate --settings slow.yaml --jobs 1 --json out.json \
    --update --report page.html >out 2>err &
tester=$!
for _ in $(seq 500); do
    grep -qs '^passed *quick' out && comparison=$(pgrep -P $tester) && break
    sleep 0.02
done
kill -KILL "${comparison:-none}" # as when memory is out
wait $tester
[ $? -eq 1 ] || problem 'not exit code 1 after a comparison crashed'
is quick.pgm passed
is slow.pgm broken
says out 'comparing the pictures ended by signal 9 \(Killed\)'
[ "$(head -c 30 reference/slow.pgm | tail -c 1)" = r ] || problem 'a picture that was never compared was accepted'
expect 1 "$tool" test --reference reference --candidate candidate --settings slow.yaml --timeout 0.2 --json out.json
is quick.pgm passed
is slow.pgm broken
says out 'comparing the pictures was ended after the time limit of 0.2 s'

# Ctrl-C: ends what runs, says so, leaves nothing. Without --foreground timeout sends it twice, and the
# second ends the tester at once.
tests "cases: {slow: {run: [sh, -c, 'sleep $nap; : {output}']}}"
timeout --foreground --preserve-status -s INT 1 "$tool" test t >out 2>err
[ $? -eq 130 ] || problem 'not exit code 130 after Ctrl-C'
says err interrupted
[ ! -e lavaray-test ] || problem 'left behind after Ctrl-C'
pgrep -f "sleep $nap" >/dev/null && problem 'a command went on after Ctrl-C'

finish
