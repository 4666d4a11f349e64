// sconce info and verify: what is in a light field's file.
#include <iostream>

#include <fmt/format.h>

#include "runtime/field/light_field_file.h"
#include "tools/field_report.h"

namespace sconce::tools
{

namespace
{

struct FileOptions
{
    std::string file;
};

int runInfo(const FileOptions& options, const Context& context)
{
    const Result<FieldData> field = loadField(options.file);
    if (!field) return fail(field.error());
    if (context.json)
        print(fieldJson(*field));
    else
        printField(*field, options.file);
    return exitOk;
}

int runVerify(const FileOptions& options, const Context& context)
{
    const Result<VerifyReport> report = verifyField(options.file);
    if (!report) return fail(report.error());
    if (context.json)
    {
        Json json;
        json["ok"] = report->ok();
        json["version"] = report->version;
        json["bytes"] = report->fileBytes;
        json["blocks"] = Json::array();
        for (const BlockReport& block : report->blocks)
            json["blocks"].push_back({{"name", block.name},
                                      {"ok", block.problem.empty()},
                                      {"problem", block.problem},
                                      {"offset", block.offset},
                                      {"stored_bytes", block.storedBytes},
                                      {"raw_bytes", block.rawBytes}});
        json["problem"] = report->problem;
        print(json);
    }
    else
        for (const BlockReport& block : report->blocks)
            std::cout << (block.problem.empty() ? "ok       " : "DAMAGED  ") << block.name << "  " << block.storedBytes << " bytes"
                      << (block.problem.empty() ? "" : fmt::format(": {}", block.problem)) << std::endl;
    if (report->ok()) return exitOk;
    return fail(ErrorCode::badInput, !report->problem.empty()
                                         ? report->problem
                                         : fmt::format("'{}' is damaged; bake it again or restore it from a copy.", options.file));
}

} // namespace

void addFieldCommands(CLI::App& app, Context& context)
{
    auto infoOptions = std::make_shared<FileOptions>();
    CLI::App* info = addCommand(app, context, "info", "What a light field consists of: probes, bytes by part, octree, effects, settings");
    info->add_option("FIELD", infoOptions->file, ".sconce file")->required()->type_name("");
    onChosen(info, context, infoOptions, runInfo);

    auto verifyOptions = std::make_shared<FileOptions>();
    CLI::App* verify = addCommand(app, context, "verify", "Checks every checksum of a light field; exit 3 when it is damaged");
    verify->add_option("FIELD", verifyOptions->file, ".sconce file")->required()->type_name("");
    onChosen(verify, context, verifyOptions, runVerify);
}

} // namespace sconce::tools
