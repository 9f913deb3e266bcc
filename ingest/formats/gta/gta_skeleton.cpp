#include "ingest/formats/gta/gta_skeleton.hpp"

namespace actformer::ingest {

std::vector<float> gta_bone_lengths() {
    return {0,      0.114F, 0.244F, 0.0585F, 0.166F, 0.267F, 0.253F, 0.0585F, 0.166F, 0.267F, 0.253F,
            0.116F, 0.074F, 0.071F, 0.023F,  0.114F, 0.118F, 0.411F, 0.404F,  0.118F, 0.411F, 0.404F};
}

}  // namespace actformer::ingest
