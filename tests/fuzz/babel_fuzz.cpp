// libFuzzer: any bytes as BABEL's annotations. What is taken has paths and times, what is refused is one line.
#include <cmath>
#include <cstdlib>

#include "ingest/formats/babel/annotations.hpp"
#include "ingest/formats/babel/sequence_files.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer::ingest;
using namespace actformer::fuzzing;

namespace {

void check(const Rejection& rejection) {
    demand_one_line(rejection.reason);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(data, data + size);
    const auto said = read_annotations(text);
    if (const auto* rejection = std::get_if<Rejection>(&said)) {
        check(*rejection);
        return 0;
    }
    SequenceFiles files;
    const auto& annotations = std::get<Annotations>(said);
    for (const auto& fault : annotations.faults) check(fault);
    for (std::size_t i = 0; i < annotations.sequences.size(); ++i) {
        const auto& sequence = annotations.sequences[i];
        demand(!sequence.feat_p.empty());
        const bool named = files.add(sequence.feat_p);
        const auto found = files.of(sequence.feat_p);
        demand(!named || std::find(found.begin(), found.end(), i) != found.end());
        for (const auto& segment : sequence.segments)
            demand(std::isfinite(segment.start.value_or(0)) && std::isfinite(segment.end.value_or(0)));
    }
    return 0;
}
