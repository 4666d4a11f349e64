// Loaded before the C library (LD_PRELOAD), it makes the n-th call of a kind fail, of those for files under a folder. Files elsewhere, a
// driver's or the loader's, are left alone. fiu-run would do for chances, but it neither counts calls nor tells files apart, and has no
// mkostemp.
//
// The environment's SCONCE_FILE_FAULT says KIND:N:ERRNO:FOLDER. Kinds: open, read, write, sync, rename, close, resize; `folder`, to open or
// sync one; `short`, where each write takes half of what it is given, and none fails. N counts from 1. At the program's end stderr is told
// how many calls of each kind there were.
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <sys/uio.h>
#include <unistd.h>

namespace
{

constexpr int kMostFiles = 1024;
enum : char
{
    nobodys,
    file,
    folder
};
std::atomic<char> opened[kMostFiles]; // what of the folder's a descriptor is of

struct Wanted
{
    std::string kind, folder;
    int number = 0, error = 0;
};

const Wanted& wanted()
{
    static const Wanted made = []
    {
        Wanted of;
        const char* text = std::getenv("SCONCE_FILE_FAULT");
        if (text == nullptr) return of;
        const std::string all = text;
        const size_t first = all.find(':'), second = all.find(':', first + 1), third = all.find(':', second + 1);
        of.kind = all.substr(0, first);
        of.number = std::atoi(all.c_str() + first + 1);
        of.error = std::atoi(all.c_str() + second + 1);
        of.folder = all.substr(third + 1);
        return of;
    }();
    return made;
}

bool isOurs(const char* path)
{
    return path != nullptr && !wanted().folder.empty() && std::string_view(path).starts_with(wanted().folder);
}

char kindOf(int descriptor)
{
    return descriptor >= 0 && descriptor < kMostFiles ? opened[descriptor].load() : char(nobodys);
}

struct Kind
{
    const char* name;
    std::atomic<int> calls{0};
};
Kind opening{"open"}, reading{"read"}, writing{"write"}, syncing{"sync"}, renaming{"rename"}, closing{"close"}, resizing{"resize"},
    ofFolder{"folder"};

__attribute__((destructor)) void tellCalls()
{
    if (wanted().folder.empty()) return;
    for (const Kind* kind : {&opening, &reading, &writing, &syncing, &renaming, &closing, &resizing, &ofFolder})
        std::fprintf(stderr, "calls: %s %d\n", kind->name, kind->calls.load());
}

/// Counts a call. @return  whether it is the one that fails; errno is set
bool fails(Kind& kind)
{
    if (++kind.calls != wanted().number || wanted().kind != kind.name) return false;
    errno = wanted().error;
    return true;
}

size_t taken(size_t bytes)
{
    return wanted().kind == "short" && bytes > 1 ? bytes / 2 : bytes;
}

/// The C library's function of a name.
template <class F> F* next(F*, const char* name)
{
    return reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
}
#define NEXT(name) static auto* const real = next(&::name, #name)

int noted(int descriptor, bool ours, int flags = 0)
{
    if (descriptor >= 0 && descriptor < kMostFiles) opened[descriptor] = !ours ? nobodys : (flags & O_DIRECTORY) != 0 ? folder : file;
    return descriptor;
}

Kind& openKind(int flags)
{
    return (flags & O_DIRECTORY) != 0 ? ofFolder : opening;
}

mode_t modeIn(va_list arguments, int flags)
{
    return (flags & (O_CREAT | O_TMPFILE)) != 0 ? mode_t(va_arg(arguments, int)) : 0;
}

} // namespace

extern "C"
{

#define SCONCE_OPEN(name)                                                                                                                  \
    int name(const char* path, int flags, ...)                                                                                             \
    {                                                                                                                                      \
        NEXT(name);                                                                                                                        \
        va_list arguments;                                                                                                                 \
        va_start(arguments, flags);                                                                                                        \
        const mode_t mode = modeIn(arguments, flags);                                                                                      \
        va_end(arguments);                                                                                                                 \
        if (isOurs(path) && fails(openKind(flags))) return -1;                                                                             \
        return noted(real(path, flags, mode), isOurs(path), flags);                                                                        \
    }
    SCONCE_OPEN(open)
    SCONCE_OPEN(open64)

#define SCONCE_FOPEN(name)                                                                                                                 \
    FILE* name(const char* path, const char* mode)                                                                                         \
    {                                                                                                                                      \
        NEXT(name);                                                                                                                        \
        if (isOurs(path) && fails(opening)) return nullptr;                                                                                \
        FILE* stream = real(path, mode);                                                                                                   \
        if (stream != nullptr) noted(fileno(stream), isOurs(path));                                                                        \
        return stream;                                                                                                                     \
    }
    SCONCE_FOPEN(fopen)
    SCONCE_FOPEN(fopen64)

    int fclose(FILE* stream)
    {
        NEXT(fclose);
        noted(fileno(stream), false); // its number is the next file's
        return real(stream);
    }

#define SCONCE_MKOSTEMP(name)                                                                                                              \
    int name(char* pattern, int flags)                                                                                                     \
    {                                                                                                                                      \
        NEXT(name);                                                                                                                        \
        if (isOurs(pattern) && fails(opening)) return -1;                                                                                  \
        return noted(real(pattern, flags), isOurs(pattern));                                                                               \
    }
    SCONCE_MKOSTEMP(mkostemp)
    SCONCE_MKOSTEMP(mkostemp64)

    ssize_t read(int descriptor, void* bytes, size_t size)
    {
        NEXT(read);
        return kindOf(descriptor) == file && fails(reading) ? -1 : real(descriptor, bytes, size);
    }
    ssize_t write(int descriptor, const void* bytes, size_t size)
    {
        NEXT(write);
        if (kindOf(descriptor) != file) return real(descriptor, bytes, size);
        return fails(writing) ? -1 : real(descriptor, bytes, taken(size));
    }
#define SCONCE_PREAD(name, Offset)                                                                                                         \
    ssize_t name(int descriptor, void* bytes, size_t size, Offset offset)                                                                  \
    {                                                                                                                                      \
        NEXT(name);                                                                                                                        \
        return kindOf(descriptor) == file && fails(reading) ? -1 : real(descriptor, bytes, size, offset);                                  \
    }
    SCONCE_PREAD(pread, off_t)
    SCONCE_PREAD(pread64, off64_t)
#define SCONCE_PWRITE(name, Offset)                                                                                                        \
    ssize_t name(int descriptor, const void* bytes, size_t size, Offset offset)                                                            \
    {                                                                                                                                      \
        NEXT(name);                                                                                                                        \
        if (kindOf(descriptor) != file) return real(descriptor, bytes, size, offset);                                                      \
        return fails(writing) ? -1 : real(descriptor, bytes, taken(size), offset);                                                         \
    }
    SCONCE_PWRITE(pwrite, off_t)
    SCONCE_PWRITE(pwrite64, off64_t)

    int fsync(int descriptor)
    {
        NEXT(fsync);
        const char kind = kindOf(descriptor);
        if (kind != nobodys && fails(kind == folder ? ofFolder : syncing)) return -1;
        return real(descriptor);
    }
    int rename(const char* from, const char* to)
    {
        NEXT(rename);
        return isOurs(to) && fails(renaming) ? -1 : real(from, to);
    }
    int ftruncate(int descriptor, off_t size) noexcept
    {
        NEXT(ftruncate);
        return kindOf(descriptor) == file && fails(resizing) ? -1 : real(descriptor, size);
    }
    int close(int descriptor)
    {
        NEXT(close);
        const char kind = kindOf(descriptor);
        if (kind != nobodys) opened[descriptor] = nobodys;
        const int result = real(descriptor); // as on Linux: it is closed whatever it says
        return kind == file && fails(closing) ? -1 : result;
    }

} // extern "C"
