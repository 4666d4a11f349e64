#!/usr/bin/env python3
"""The names of the GLSL that hosts include: all are told apart from a host's own by `sconce`. What that text calls luminance() or Ray is sconceLuminance() and
SconceRay to who includes sconce.glsl, sconce_frame.glsl or sconce_probe_face.glsl, by the macros of shaders/host_names.glsl.

host_names.py GLSLANG SHADERS            checks that host_names.glsl and its end list what there is, and that a host may give each name to something of its own
host_names.py GLSLANG SHADERS --write    writes both
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ENTRIES = ("light_field.glsl", "lamps.glsl", "shared/frame.h", "probe_face.glsl")
WRAPPERS = ("sconce.glsl", "sconce_frame.glsl", "sconce_probe_face.glsl")
OPEN = ("RayHit", "Ray", "LightFieldInfo", "FrameView", "BrdfSurface", "BrdfLobes", "BrdfValue", "IndirectSent", "SconceProbeSurface", "TraceRaysPush", "TraceQuality")  # whose members hosts name
HEAD = "#version 460\n#extension GL_GOOGLE_include_directive : require\n"
STREAMS = "#define SCONCE_ASKS_FOR_MAPS\n"  # what a host's pass says that asks a field that streams: it gets more names
OTHERWISE = {"irradianceAt": "sconceIrradianceOfProbes"}  # the name that the others' rule gives is taken
MAIN = "layout(local_size_x = 1) in;\nvoid main() {}\n"


def glslang(program, shaders, text, *options):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "host.comp")
        file.write_text(text)
        run = subprocess.run([program, *options, f"-I{shaders}", str(file), *(["-o", f"{folder}/host.spv"] if "-E" not in options else [])],
                             capture_output=True, text=True, check=False)
    return run.returncode, run.stdout + run.stderr


def preprocessed(program, shaders, includes):
    code, text = glslang(program, shaders, HEAD + STREAMS + "".join(f'#include "{file}"\n' for file in includes) + MAIN, "-E")
    if code != 0:
        sys.exit(f"host_names.py: {text}")
    return re.sub(r"^\s*#.*$", "", text, flags=re.M)


def declared(text):
    """(Names of global scope, members by struct)."""
    names, members = set(), {}
    body = re.compile(r"\{[^{}]*\}")
    flat, blocks = text, []

    def fold(found):
        blocks.append(found.group(0)[1:-1])
        return f"\x01{len(blocks) - 1}\x02"
    while "{" in flat:
        flat = body.sub(fold, flat)
    fields = lambda block: [re.split(r"[\[=]", part.split()[-1])[0] for line in blocks[block].split(";") if line.strip()
                            for part in line.replace(",", " x ").split(" x ") if part.strip()]
    flat = re.sub(r"layout\s*\([^)]*\)", "", flat)
    for struct, block in re.findall(r"\bstruct\s+(\w+)\s*\x01(\d+)\x02", flat):
        names.add(struct)
        members[struct] = fields(int(block))
    for block, instance in re.findall(r"\b(?:buffer|uniform)\s+\w+\s*\x01(\d+)\x02\s*(\w*)\s*;", flat):
        names |= {instance} if instance else set(fields(int(block)))
    names |= set(re.findall(r"\b(?:buffer|uniform)\s+(\w+)\s*\x01", flat))
    names |= set(re.findall(r"\b(\w+)\s*\([^()]*\)\s*\x01", flat))
    outside = re.sub(r"\x01\d+\x02", "{}", flat)
    names |= set(re.findall(r"\bconst\s+\w+\s+(\w+)\s*(?:\[[^\]]*\])?\s*=", outside))
    names |= set(re.findall(r"\buniform\s+\w+\s+(\w+)\s*;", outside))
    return names - {"main"}, members


def macros(shaders):
    """Those that the included text leaves to hosts without the prefix, as they are defined."""
    found = []
    for file in [shaders / entry for entry in ENTRIES] + sorted((shaders / "shared").glob("*.h")):
        found += re.findall(r"^#define (?!SCONCE)(\w+(?:\(\))? .*?)(?: *//.*)?$", file.read_text(), flags=re.M)
    return sorted(set(found))


def renamed(name):
    if name in OTHERWISE:
        return OTHERWISE[name]
    if re.match(r"k[A-Z]", name):
        return "kSconce" + name[1:]
    return ("Sconce" if name[0].isupper() else "sconce") + name[0].upper() + name[1:]


def is_told_apart(name):
    return re.match(r"k?[sS]conce([A-Z]|$)", name) is not None


def listed(names, kept):
    begin = ["// Names that what follows has to a host, up to host_names_end.glsl. Written by tests/shaders/host_names.py."]
    begin += [f"#define {macro}" for macro in kept] + [f"#define {name} {renamed(name)}" for name in names]
    end = ["// Gives a host its names back that host_names.glsl took. Written by tests/shaders/host_names.py."]
    end += [f"#undef {re.match(chr(92) + 'w+', macro).group(0)}" for macro in kept] + [f"#undef {name}" for name in names]
    return "\n".join(begin) + "\n", "\n".join(end) + "\n"


def main():
    program, shaders = sys.argv[1], Path(sys.argv[2])
    all_names, members = declared(preprocessed(program, shaders, ENTRIES))
    names = sorted(name for name in all_names if not is_told_apart(name))
    kept = macros(shaders)
    faults = [f"{struct}.{name} has the name of something global, so that hosts would have to call it {renamed(name)}"
              for struct in OPEN for name in members.get(struct, [f"(there is no {struct})"]) if name in names or name.startswith("(")]
    targets = [renamed(name) for name in names]
    faults += [f"{name} is two things to a host" for name in targets if targets.count(name) > 1 or name in all_names]
    files = dict(zip((shaders / "host_names.glsl", shaders / "host_names_end.glsl"), listed(names, kept)))
    for file, text in files.items():
        if sys.argv[3:] == ["--write"]:
            file.write_text(text)
        elif not file.is_file() or file.read_text() != text:
            faults.append(f"{file} isn't what there is; run: python3 tests/shaders/host_names.py {program} {shaders} --write")
    found, _ = declared(preprocessed(program, shaders, WRAPPERS))
    faults += [f"a host gets the name {name}" for name in sorted(found) if not is_told_apart(name)]
    # A host that has all of these names for itself, before and after.
    own = names + [re.match(r"\w+", macro).group(0) for macro in kept]
    declared_here = "".join(f"float {name};\n" for name in own)
    includes = "".join(f'#include "{file}"\n' for file in WRAPPERS)
    used = ("layout(local_size_x = 1) in;\nvoid main() { vec3 light = sconceLightAt(vec3(0.0), vec3(1.0), vec3(1.0)); "
            "SconceRayHit hit = sconceQuery(light, light, light); }\n")
    for where, text in (("before", STREAMS + declared_here + includes), ("after", includes + declared_here)):
        code, said = glslang(program, shaders, HEAD + text + used, "--quiet", "--target-env", "vulkan1.2")
        if code != 0:
            faults.append(f"a host that has these names itself, {where} what it includes: {said}")
    for fault in faults:
        print(f"host_names.py: {fault}", file=sys.stderr)
    print(f"{len(names)} names and {len(kept)} macros, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
