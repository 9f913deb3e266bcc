// The BVH reader and the name patterns on arbitrary bytes: what is taken must be whole, what is refused one
// line.
#include <cmath>
#include <cstdlib>
#include <string>

#include "base/error.hpp"
#include "ingest/formats/bvh/bvh_file.hpp"
#include "ingest/formats/name_pattern.hpp"
#include "ingest/formats/skeletal/skeleton.hpp"

using namespace actformer;

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

void check_taken(const ingest::Recording& file) {
    require(!file.joints.empty() && file.frames > 0);
    require(file.values.size() == std::size_t{file.channels} * file.frames);
    for (const float v : file.values) require(std::isfinite(v));
    require(std::isfinite(file.fps()) && file.fps() > 0);
    std::uint32_t channels = 0;
    for (std::size_t j = 0; j < file.joints.size(); ++j) {
        require(file.joints[j].parent < static_cast<int>(j) && (file.joints[j].parent < 0) == (j == 0));
        require(file.joints[j].first_channel == channels);
        channels += static_cast<std::uint32_t>(file.joints[j].channels.size());
    }
    require(channels == file.channels);
    const auto skeleton = ingest::skeleton_below(file, ingest::automatic_root(file), true);
    skeleton.topology.check("fuzz");
    require(ingest::first_difference(skeleton.topology, skeleton.topology).empty());
}

void read_file(const std::string& bytes) {
    // The 64 zero bytes that readers may load, and not one more, so that AddressSanitizer sees what is
    // beyond.
    std::vector<char> padded(bytes.begin(), bytes.end());
    padded.resize(bytes.size() + 64);
    const auto result = ingest::parse_bvh({padded.data(), bytes.size()});
    if (const auto* persons = std::get_if<std::vector<ingest::Recording>>(&result)) {
        require(!persons->empty());
        for (const auto& person : *persons) check_taken(person);
        return;
    }
    const auto& reason = std::get<ingest::Rejection>(result).reason;
    require(reason.starts_with("line ") && reason.find('\n') == std::string::npos && reason.size() < 300);
}

/// The first line is the pattern, the rest the name.
void match_name(const std::string& bytes) {
    const auto cut = std::min(bytes.find('\n'), bytes.size());
    try {
        const ingest::NamePattern pattern(std::string_view(bytes).substr(0, cut));
        const auto values = pattern.match(std::string_view(bytes).substr(std::min(cut + 1, bytes.size())));
        if (values) require(values->size() == pattern.fields().size());
    } catch (const Error&) {  // a bad pattern
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    const std::string bytes(data, data + size);
    read_file(bytes);
    match_name(bytes);
    return 0;
}
