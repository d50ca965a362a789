# The reports of `lavaray test`: JUnit's XML and JSON are well-formed and say the same, whatever the
# names and outputs hold.
. tests/cli/lib.sh
tool=$(realpath "$LAVARAY")
command -v python3 >/dev/null || { echo 'no python3' >&2; exit 77; }
cd "$work" || exit 1

mkdir -p t/golden
for name in good bad; do
    echo 'P2 2 1 255 1 2' >"t/golden/$name.pgm"
done
echo 'P2 2 1 255 1 2' >t/golden/$'odd \377 <&"name>.pgm'
printf 'P2 2 1 255 1 2' >good.pgm
printf 'P2 2 1 255 1 9' >bad.pgm
cat >t/tests.yaml <<'END'
cases:
  good: {run: [cp, good.pgm, "{output}"]}
  bad: {run: [sh, -c, "echo '</script><b>&amp;]]>'; cp bad.pgm $0", "{output}"]}
  new: {run: [cp, good.pgm, "{output}"], format: pgm}
  "a <\"name\"> & 'more'": {run: [sh, -c, "printf '\\033[31mred\\033[0m \\001\\376\\n'; exit 3", "{output}"]}
  late: {run: [sh, -c, "sleep 9; : {output}"], timeout: 0.2}
END
expect 1 "$tool" test t --junit sub/junit.xml --json out.json --report page.html
cat >check.py <<'END'
import collections, json, xml.etree.ElementTree as tree

suite = tree.parse("sub/junit.xml").getroot().find("testsuite")
report = json.load(open("out.json"))
cases = {case["name"]: case for case in report["cases"]}
assert len(cases) == 5 and report["failures"] == 4, report["counts"]
assert suite.attrib["tests"] == "5" and suite.attrib["failures"] == "2" and suite.attrib["errors"] == "2", suite.attrib
assert suite.attrib["name"] == "t"
for case in suite.findall("testcase"):
    told = cases.pop(case.attrib["name"])
    failure = case.find("failure") if case.find("failure") is not None else case.find("error")
    assert (failure is not None) == told["failed"], told
    if told["failed"]:
        assert failure.attrib["message"] == told["message"]
        assert failure.attrib["type"] == told["outcome"]
    assert float(case.attrib["time"]) >= 0
assert not cases
cases = {case["name"]: case for case in report["cases"]}
odd = cases["a <\"name\"> & 'more'"]
assert odd["output"] == "red ??" and odd["message"].endswith("exit code 3"), odd
assert odd["rerun"] == "lavaray test t -k 'a <\"name\"> & '\\''more'\\'''", odd["rerun"]
assert "accept" not in odd and cases["bad"]["accept"] == "lavaray test t -k bad --update"
assert cases["bad"]["output"] == "</script><b>&amp;]]>"
metric, = cases["bad"]["compare"]["metrics"]
assert metric["name"] == "exact" and metric["pixels"] == 1 and metric["value"] == 50 and not metric["pass"], metric
assert cases["late"]["message"] == "ended after the time limit of 0.2 s"
assert report["cpu"] and report["version"] and report["started"].endswith("Z")

# The page holds the same, in one script that nothing in the data ends, and asks for nothing else.
page = open("page.html", encoding="utf-8").read()
data = page.split('<script type="application/json" id="data">')[1].split("</script>")[0]
shown = json.loads(data)
names = collections.Counter(tuple(case.get("pictures", {})) for case in shown["cases"])
assert names[("reference", "candidate", "difference")] == 1 and names[("candidate",)] == 1, names
for case in shown["cases"]:
    case.pop("pictures", None)
assert shown == report
rest = page.replace(data, "")
assert "@" + "DATA@" not in rest and "@" + "STYLE@" not in rest and "http" not in rest.replace("http-equiv", "")
assert page.count("</script>") == 2
END
python3 check.py || problem 'a report is not what was expected'
if command -v xmllint >/dev/null; then
    xmllint --noout sub/junit.xml || problem 'xmllint refuses the XML'
fi

# Of cases that pass, pictures only when asked for.
expect 0 "$tool" test t -k good --report page.html
grep -q data:image/png page.html && problem 'pictures of a case that passed'
expect 0 "$tool" test t -k good --report page.html --embed-all
[ "$(grep -o data:image/png page.html | wc -l)" -eq 2 ] || problem 'no pictures with --embed-all'

# A report on standard output stands there alone.
expect 1 "$tool" test t --json -
python3 -m json.tool "$work/out" >/dev/null || problem '--json - is not JSON alone'
says err 'differs +bad'
expect 1 "$tool" test t --junit -
head -n 1 "$work/out" | grep -q '^<?xml' || problem '--junit - is not XML alone'
expect 2 "$tool" test t --junit - --json - && one_line
(cd t && "$tool" test . --json - 2>/dev/null) >"$work/out"
says out '"title": "t"'

# Colours on a terminal alone, and not with NO_COLOR.
escape=$(printf '\033')
colored() {
    script -qec "$* $tool test t -k good" /dev/null </dev/null | grep -q "$escape"
}
if command -v script >/dev/null; then
    colored env TERM=xterm || problem 'no colour on a terminal'
    colored env TERM=xterm NO_COLOR=1 && problem 'colour in spite of NO_COLOR'
    colored env TERM=dumb && problem 'colour on a dumb terminal'
fi
mkdir -p t/golden reference candidate
echo 'P2 2 1 255 1 2' >reference/"$escape[31mred.pgm"
"$tool" test --reference reference --candidate candidate >out 2>err
grep -q "$escape" out err && problem 'an escape sequence from the name of a file'
finish
