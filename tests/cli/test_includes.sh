# The folders of src include only downwards (src/README.md), and only some see the system's libraries.
set -u
failures=0

problem() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}

# may_include FOLDER: the folders whose headers it may include.
may_include() {
    case $1 in
    base) echo base ;;
    scene) echo scene image base ;;
    bvh) echo bvh base ;;
    gpu) echo gpu base ;;
    image) echo image base ;;
    compare) echo compare image base ;;
    render) echo render scene bvh gpu image base ;;
    tester) echo tester compare scene image base ;;
    preview) echo preview render scene bvh gpu image base ;;
    cli) echo cli tester preview render scene bvh gpu compare image base ;;
    esac
}

for folder in src/*/; do
    name=$(basename "$folder")
    allowed=$(may_include "$name")
    [ -n "$allowed" ] || problem "$folder has no place in the layers"
    while IFS=: read -r file include; do
        included=$(printf '%s' "$include" | sed 's/.*"\(.*\)".*/\1/')
        case $included in
        lavaray.h) ;;
        gpu_layout.h | *.spv.h) # what host and kernels share
            case $name in gpu | render) ;; *) problem "$file includes $included" ;; esac
            ;;
        albedo.h) # tables that the build makes
            case $name in render) ;; *) problem "$file includes $included" ;; esac
            ;;
        report.html.h) # the page of the tester
            case $name in tester) ;; *) problem "$file includes $included" ;; esac
            ;;
        */*)
            case " $allowed " in
            *" ${included%%/*} "*) ;;
            *) problem "$file includes $included" ;;
            esac
            ;;
        *) problem "$file includes $included without its folder" ;;
        esac
    done < <(grep -HE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' "$folder"*.[ch])
done

# only HEADER FOLDER...: no other folder includes <HEADER...>.
only() {
    local pattern=$1 found
    shift
    found=$(grep -lE "^[[:space:]]*#[[:space:]]*include[[:space:]]*<$pattern" src/*.h src/*/*.[ch])
    for file in $found; do
        case " $* " in
        *" $(basename "$(dirname "$file")") "*) ;;
        *) problem "$file includes <$pattern>" ;;
        esac
    done
}
only vulkan/ gpu
only GLFW/ preview
only cairo/ preview
only libfyaml scene
only png image
only stb image
only OpenEXR/ image
only jansson cli scene tester

# The public header stands alone.
if grep -qE '#[[:space:]]*include[[:space:]]*"' src/lavaray.h; then
    problem "src/lavaray.h includes a header of ours"
fi
printf '#include "lavaray.h"\n' | cc -std=c17 -Wall -Wextra -Wpedantic -Werror -Isrc -x c -fsyntax-only - ||
    problem "src/lavaray.h does not compile alone"

exit "$((failures > 0))"
