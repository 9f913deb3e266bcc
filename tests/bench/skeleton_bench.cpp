// How fast raw NTU text becomes limbs on one core, the text in cache: the limit of `ingest ntu`.
#include <benchmark/benchmark.h>

#include "base/checksum/checksum.hpp"
#include "base/files/file.hpp"
#include "base/text/lines.hpp"
#include "ingest/formats/ntu/skeleton_file.hpp"
#include "ingest/synth/ntu/ntu.hpp"

namespace {

using namespace actformer;
using namespace actformer::ingest;

/// A synthetic clip and the zero bytes that readers may load.
struct Clip {
    Clip() : bytes(synth::skeleton_text({}, 1)), size(bytes.size()) { bytes.append(text_padding, '\0'); }
    std::string_view text() const { return {bytes.data(), size}; }
    std::string bytes;
    std::size_t size;
};

template <typename Body>
void over_a_clip(benchmark::State& state, Body body) {
    const Clip clip;
    for (auto _ : state) benchmark::DoNotOptimize(body(clip.text()));
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * clip.size));
}

void read_clip(benchmark::State& state) {
    over_a_clip(state, [](std::string_view text) { return read_skeleton(text); });
}

void find_lines_only(benchmark::State& state) {
    over_a_clip(state, [](std::string_view text) {
        int lines = 0, fields = 0;
        for (const char *p = text.data(), *end = p + text.size(); p < end; ++lines)
            p = end_of_line(p, end, fields) + 1;
        return lines;
    });
}

void checksum_clip(benchmark::State& state) {
    over_a_clip(state, [](std::string_view text) { return checksum(text); });
}

}  // namespace

BENCHMARK(read_clip);
BENCHMARK(find_lines_only);
BENCHMARK(checksum_clip);
BENCHMARK_MAIN();
