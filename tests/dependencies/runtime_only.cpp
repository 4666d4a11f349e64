// The smallest host: it links the runtime alone and touches the file loader and the device, so that both are linked in.
#include <cstdio>

#include "runtime/field/light_field_file.h"
#include "runtime/vulkan/host_vulkan.h"

int main(int argc, char** argv)
{
    const sconce::Result<sconce::VerifyReport> report = sconce::verifyField(argc > 1 ? argv[1] : "none.sconce");
    const sconce::Result<std::vector<sconce::DeviceSummary>> devices = sconce::deviceSummary();
    std::printf("%d %d\n", report.ok(), devices.ok());
    return 0;
}
