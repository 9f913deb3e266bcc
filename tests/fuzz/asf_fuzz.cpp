// Acclaim's skeletons and motions on arbitrary bytes: what is taken must be whole, what is refused one line.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "ingest/formats/asf/amc_file.hpp"
#include "ingest/formats/skeletal/skeleton.hpp"

using namespace actformer;

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

/// The 64 zero bytes that readers may load, and not one more, so that AddressSanitizer sees what is beyond.
std::vector<char> padded(const std::string& text) {
    std::vector<char> out(text.begin(), text.end());
    out.resize(text.size() + 64);
    return out;
}

void check_refused(const ingest::Rejection& rejection) {
    const auto& reason = rejection.reason;
    require(reason.starts_with("line ") && reason.find('\n') == std::string::npos && reason.size() < 300);
}

void check_taken(const ingest::Recording& recording, const ingest::AsfSkeleton& skeleton) {
    require(recording.frames > 0 &&
            recording.values.size() == std::size_t{recording.channels} * recording.frames);
    for (const float v : recording.values) require(std::isfinite(v));
    const auto kept = ingest::skeleton_below(recording, 0, true);
    kept.topology.check("fuzz");
    require(kept.topology.joints() == skeleton.bones.size() + 1);
}

}  // namespace

/// A skeleton, the byte 0x1E, and a motion.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    const std::string bytes(data, data + size);
    const auto cut = std::min(bytes.find('\x1E'), bytes.size());
    const auto asf = padded(bytes.substr(0, cut)),
               amc = padded(bytes.substr(std::min(cut + 1, bytes.size())));
    const auto skeleton = ingest::parse_asf({asf.data(), asf.size() - 64});
    if (const auto* rejection = std::get_if<ingest::Rejection>(&skeleton)) {
        check_refused(*rejection);
        return 0;
    }
    const auto& sound = std::get<ingest::AsfSkeleton>(skeleton);
    const auto recording = ingest::parse_amc({amc.data(), amc.size() - 64}, sound);
    if (const auto* rejection = std::get_if<ingest::Rejection>(&recording))
        check_refused(*rejection);
    else
        check_taken(std::get<ingest::Recording>(recording), sound);
    return 0;
}
