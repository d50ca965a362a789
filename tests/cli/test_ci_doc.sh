# The jobs of docs/ci.md: they are YAML, do the same, and name only what exists.
. tests/cli/lib.sh
command -v python3 >/dev/null || { echo 'no python3' >&2; exit 77; }
root=$PWD

# Blocks of YAML to $work/job1, job2; their commands, one a line, to $work/commands1, commands2.
python3 - "$work" <<'END' || problem 'docs/ci.md has not two jobs of the same commands'
import re, sys
blocks = re.findall(r"```yaml\n(.*?)```", open("docs/ci.md").read(), re.S)
assert len(blocks) == 2, len(blocks)
commands = []
for i, block in enumerate(blocks, 1):
    open(f"{sys.argv[1]}/job{i}", "w").write(block)
    own = re.findall(r"^ +(?:- )?((?:apt-get|git|ln|/opt/lavaray/|lavaray) ?.*)$", block, re.M)
    open(f"{sys.argv[1]}/commands{i}", "w").write("\n".join(own) + "\n")
    commands.append(own)
    try:
        import yaml
        job = yaml.safe_load(block)
        job = job.get("jobs", job)["images"]
        run = [step["run"] for step in job["steps"] if "run" in step] if "steps" in job else \
            job["before_script"] + job["script"]
        assert "\n".join(run).split() == "\n".join(own).split(), run
    except ImportError:
        print("no python3-yaml: the jobs' structure is not checked", file=sys.stderr)
assert commands[0] == commands[1] and len(commands[0]) == 6, commands
END

while read -r line; do
    set -- $line
    case $1 in
    /opt/lavaray/*) [ -x "$root/${1#/opt/lavaray/}" ] || problem "$1 is not in the repository" ;;
    ln) grep -q "build/release/lavaray" "$root/tools/run" || problem 'tools/run does not build what is linked' ;;
    lavaray) "$LAVARAY" "$2" --help >/dev/null || problem "there is no lavaray $2" ;;
    esac
    for word in "$@"; do
        case $1:$word in
        lavaray:--*) "$LAVARAY" "$2" --help | grep -q -e " $word " || problem "$2 has no $word" ;;
        esac
    done
done <"$work/commands1"
icd=$(sed -n 's/.*VK_ICD_FILENAMES: //p' docs/ci.md | sort -u)
[ "$(printf '%s\n' "$icd" | wc -l)" -eq 1 ] || problem "several drivers: $icd"
if [ "$(uname -m)" = x86_64 ] && [ -d /usr/share/vulkan/icd.d ]; then
    [ -f "$icd" ] || problem "$icd is not where Debian has it"
fi
grep -q 'mesa-vulkan-drivers' "$root/tools/setup" || problem 'the driver is in another package'
finish
