#include "ingest/dataset/origin.hpp"

#include <fmt/format.h>

#include <vector>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

constexpr const char* marker = "ORIGIN";
constexpr std::uint64_t largest_marker = 1 << 10;

}  // namespace

std::string_view name_of(DataOrigin::Kind kind) {
    switch (kind) {
        case DataOrigin::Kind::recorded:
            return "recorded";
        case DataOrigin::Kind::synthetic:
            return "synthetic";
        case DataOrigin::Kind::stand_in:
            return "stand-in";
    }
    return "recorded";
}

DataOrigin::Kind origin_named(std::string_view name, const std::string& where) {
    for (const auto kind : DataOrigin::kinds)
        if (name == name_of(kind)) return kind;
    throw Error("{}: origin '{}' is none of recorded, synthetic, stand-in", where, name);
}

std::optional<DataOrigin::Kind> read_origin(const std::filesystem::path& folder) {
    const auto path = folder / marker;
    if (std::error_code error; !std::filesystem::is_regular_file(path, error)) return {};
    std::vector<char> scratch;
    const auto text = read_text(path, scratch, largest_marker);
    return origin_named(printable(text.substr(0, text.find_first_of("\r\n"))), path.string());
}

void write_origin(const std::filesystem::path& folder, DataOrigin::Kind kind) {
    write_whole(folder / marker, std::string(name_of(kind)) + "\n");
}

std::string DataOrigin::text() const {
    std::vector<std::string> said;
    if (kind) said.emplace_back(name_of(*kind));
    if (!skeleton.empty())
        said.push_back(skeleton == "generic" ? "generic skeleton" : "skeleton of " + skeleton);
    if (!part.empty()) said.push_back(part);
    return fmt::format("{}", fmt::join(said, ", "));
}

}  // namespace actformer::ingest
