#include "runtime/bake/host_memory.h"

#include <fstream>
#include <limits>
#include <string>

namespace sconce
{

uint64_t freeHostBytes()
{
    std::ifstream meminfo("/proc/meminfo"); // "MemAvailable:   21834567 kB"
    std::string name, unit;
    for (uint64_t kibibytes = 0; meminfo >> name >> kibibytes;)
    {
        if (name == "MemAvailable:") return kibibytes << 10;
        std::getline(meminfo, unit);
    }
    return std::numeric_limits<uint64_t>::max();
}

} // namespace sconce
