// libFuzzer: any bytes as YAML: a skeleton's file and a training's configuration. What is taken can be used, what is refused is one line.
#include <cstdint>
#include <string>

#include "ingest/formats/motions/topology_file.hpp"
#include "model/train/config.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

/// A key of each type.
const model::Config& presets() {
    static const model::Config config(
        "actformer", {{.name = "flag", .preset = false},
                      {.name = "batch", .preset = std::int64_t{64}, .least = 1, .most = 1e6},
                      {.name = "rate", .preset = 0.1, .least = 0},
                      {.name = "data", .preset = std::string()},
                      {.name = "prior", .preset = std::string("gp"), .choices = {"gp", "gaussian"}},
                      {.name = "drops", .preset = std::vector<std::int64_t>{10, 50}, .least = 0}});
    return config;
}

/// What a configuration says of itself says the same when it is read.
void check_configuration(const std::string& text) {
    auto config = presets();
    config.load_text(text, "c.yaml");
    auto again = presets();
    again.load_text(config.yaml(), "again.yaml");
    demand(again.differences(config).empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FileInMemory file;
    const std::string text(data, data + size);
    file.write(text);
    try_to([&] {
        const auto topology = ingest::topology_called(file.path());
        demand(!topology.names.empty() && topology.names.size() == topology.parents.size());
    });
    try_to([&] { check_configuration(text); });
    try_to([&] { presets().blank().override_with(text); });
    model::model_named_in(file.path());
    return 0;
}
