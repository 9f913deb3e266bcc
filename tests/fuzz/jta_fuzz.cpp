// libFuzzer: any bytes as JTA's annotations. What is taken holds together, what is refused is one line.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "ingest/formats/gta/jta_file.hpp"

using namespace actformer::ingest;

namespace {

void demand(bool holds) {
    if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t padding = 64;
    const auto copy = std::make_unique<char[]>(size + padding);
    std::copy(data, data + size, copy.get());
    std::memset(copy.get() + size, 0, padding);
    const auto said = read_jta({copy.get(), size});
    if (const auto* rejection = std::get_if<Rejection>(&said)) {
        demand(!rejection->reason.empty() && rejection->reason.find('\n') == std::string::npos);
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
