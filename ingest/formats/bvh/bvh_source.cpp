// Finding the example that a BVH dataset takes its topology from.
#include "base/text/printable.hpp"
#include "ingest/formats/bvh/bvh_format.hpp"
#include "ingest/pipeline/source.hpp"

namespace actformer::ingest {
namespace {

constexpr std::string_view extension = ".bvh";

std::vector<std::string> list_stems(const std::vector<std::filesystem::path>& raw) {
    std::vector<std::string> stems;
    Source source(raw, extension);
    for (RawFile file; source.next_name(file);) stems.push_back(file.stem);
    return stems;
}

/// The first sound file that fits the pattern. Throws Error where there is none, with the first fault.
BvhFile first_sound(const NamePattern& pattern, const std::vector<std::filesystem::path>& raw) {
    Source source(raw, extension);
    std::vector<char> scratch;
    std::string fault;
    for (RawFile file; source.next(file);) {
        if (!pattern.match(file.stem)) continue;
        try {
            auto parsed = parse_bvh(file.text(scratch));
            if (auto* sound = std::get_if<BvhFile>(&parsed)) return std::move(*sound);
            if (fault.empty()) fault = fmt::format("{}: {}", file.path, std::get<Rejection>(parsed).reason);
        } catch (const Error& e) {  // the file cannot be read; the next one may
            if (fault.empty()) fault = e.what();
        }
    }
    throw Error("no BVH file is sound; the first fault is in {}", fault);
}

}  // namespace

std::unique_ptr<BvhFormat> open_bvh(const BvhOptions& options,
                                    const std::vector<std::filesystem::path>& raw) {
    const NamePattern pattern(options.pattern);
    const auto actions = actions_in(list_stems(raw), pattern);
    return std::make_unique<BvhFormat>(options, actions, first_sound(pattern, raw));
}

}  // namespace actformer::ingest
