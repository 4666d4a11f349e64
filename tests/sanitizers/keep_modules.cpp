// Part of every program of a sanitized build: libraries that are closed stay loaded, so that a leak report can name them and
// tests/sanitizers/lsan.supp can tell a driver's leak from ours.
extern "C" int dlclose(void*) noexcept
{
    return 0;
}
