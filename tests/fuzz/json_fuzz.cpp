// libFuzzer: any bytes as dataset.json, as a log of checked lines, and as JSON that may be anything. What is taken keeps its checksum,
// what is refused is one line.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "base/checksum/checked_json.hpp"
#include "base/checksum/checked_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/loose_json.hpp"
#include "ingest/dataset/dataset_json.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

using Json = nlohmann::ordered_json;

/// A line of a log is read back as it was written.
void check_line(const Json& object) {
    const auto line = checked_line(object, 1);
    demand(line.find('\n') == line.size() - 1);
    auto read = json_or_discarded<Json>(line);
    demand(own_checksum_of(read) == OwnChecksum::right);
    auto written = object;
    for (const auto* own : {"line", "checksum"}) {
        read.erase(own);
        written.erase(own);
    }
    demand(read == written);
}

void check_dataset(const std::string& path) {
    const auto file = ingest::read_dataset_json(path);
    const auto& header = file.header;
    demand(header.persons > 0 && header.fps > 0 && std::isfinite(header.fps));
    demand(header.topology.names.size() == header.topology.parents.size());
    demand(header.rest.empty() || header.rest.size() == 3 * header.topology.joints());
    demand(own_checksum_of(Json::parse(ingest::to_text(file))) == OwnChecksum::right);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FileInMemory file;
    file.write({reinterpret_cast<const char*>(data), size});
    const auto& path = file.path();
    try_to([&] { check_dataset(path); });
    try_to([&] {
        const auto lines = read_checked_lines(path);
        for (const auto& object : lines.objects) check_line(object);
        if (const auto fault = lines.fault("log"); !fault.empty()) demand_one_line(fault);
    });
    try_to([&] {
        const auto json = loose::read(path);
        for (const auto& shard : loose::list(json, "shards")) loose::text(shard, "file");
        if (json.is_object()) check_line(json);
    });
    return 0;
}
