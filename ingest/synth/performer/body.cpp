#include "ingest/synth/performer/body.hpp"

#include "ingest/synth/random.hpp"

namespace actformer::ingest::synth {

Body body_of(int performer) {
    Random random{0xB0D1E5, static_cast<std::uint64_t>(performer)};
    const bool man = random.chance(0.55);
    Body body;
    body.height = (man ? 1.73 : 1.61) + 0.055 * random.normal();

    // Proportions differ by a few percent between persons of one height; legs and trunk trade against each
    // other.
    const double legs = 1 + 0.025 * random.normal();
    const double trunk = 2 - legs + 0.01 * random.normal();
    const double arms = 1 + 0.025 * random.normal();
    const double breadth = (man ? 1.03 : 0.95) * (1 + 0.04 * random.normal());
    const double s = body.scale();
    for (double* l : {&body.lower_spine, &body.upper_spine, &body.neck, &body.head, &body.shoulder_drop})
        *l *= s * trunk;
    for (double* l : {&body.upper_arm, &body.forearm, &body.hand, &body.tip, &body.thumb}) *l *= s * arms;
    for (double* l : {&body.thigh, &body.shin}) *l *= s * legs;
    for (double* l : {&body.foot, &body.ankle, &body.hip_drop}) *l *= s;
    body.shoulder *= s * breadth;
    body.hip *= s * (man ? 0.98 : 1.06);
    return body;
}

}  // namespace actformer::ingest::synth
