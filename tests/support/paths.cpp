#include "tests/support/paths.hpp"

namespace actformer::test {

std::string program() {
    return ACTFORMER_PROGRAM;
}

std::string warm_training() {
    return ACTFORMER_WARM_TRAINING;
}

std::string failing_calls() {
    return ACTFORMER_FAILING_CALLS;
}

std::string source(const std::string& file) {
    return ACTFORMER_SOURCE "/" + file;
}

std::string shared(const std::string& file) {
    return ACTFORMER_SHARED "/" + file;
}

}  // namespace actformer::test
