// libFuzzer: any bytes as a sweep's file with tables of its own. What is taken holds together, what is refused is one line.
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "reports/sweep/sweep_file.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

void check_row(const reports::SweepRow& row, const reports::Sweep& sweep) {
    demand(sweep.datasets.contains(row.data) && !row.seeds.empty());
    demand(row.repeats > 0 && row.per_class > 0 && row.window > 0);
    for (const auto& recogniser : {row.recogniser, row.single_recogniser})
        demand(recogniser.empty() || sweep.recognisers.contains(recogniser));
    demand(!row.config.empty() || !row.weights.empty() || !row.motions.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FileInMemory file;
    file.write({reinterpret_cast<const char*>(data), size});
    try_to([&] {
        const auto sweep = reports::read_sweep(file.path());
        demand(!sweep.rows.empty());
        std::set<std::string> names, cells;
        for (const auto& row : sweep.rows) {
            check_row(row, sweep);
            demand(names.insert(row.name).second);
            for (const auto& cell : row.fills) demand(cells.insert(cell).second);
        }
    });
    return 0;
}
