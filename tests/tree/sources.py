"""Which files a check of the tree looks at."""
import pathlib
import subprocess


def sources(root, *suffixes):
    """Paths of all files with these suffixes, relative to the root: those of git, new ones included, or where there is no git those of
    every folder that is neither hidden nor a build's."""
    root = pathlib.Path(root)
    git = subprocess.run(["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                         capture_output=True, text=True, check=False)
    # A tree without its own git may lie in somebody else's, which then ignores or doesn't know it.
    if git.returncode == 0 and (root / ".git").exists():
        found = [pathlib.PurePosixPath(name) for name in git.stdout.split("\0") if name]
    else:
        found = list(walk(root, root))
    return sorted(str(path) for path in found if path.suffix in suffixes and (root / path).is_file())


def walk(folder, root):
    for entry in folder.iterdir():
        if entry.is_dir():
            if not entry.name.startswith(".") and entry.name not in ("build", "out", "node_modules"):
                yield from walk(entry, root)
        else:
            yield entry.relative_to(root)
