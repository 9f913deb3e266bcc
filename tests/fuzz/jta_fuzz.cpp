// libFuzzer: any bytes as JTA's annotations. What is taken holds together, what is refused is one line.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "ingest/formats/gta/jta_file.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer::ingest;
using namespace actformer::fuzzing;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Input input(data, size, 64);
    const auto said = read_jta(input.text());
    if (const auto* rejection = std::get_if<Rejection>(&said)) {
        demand_one_line(rejection->reason);
        return 0;
    }
    const auto& file = std::get<JtaFile>(said);
    for (const auto& person : file.persons) {
        demand(!person.times.empty() && person.times.back() < file.frames &&
               std::is_sorted(person.times.begin(), person.times.end()));
        demand(person.positions.size() == person.times.size() * 22 * 3);
    }
    return 0;
}
