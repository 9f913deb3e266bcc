#include "eval/scoring/measured_motions.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "ingest/dataset/body_parts.hpp"
#include "ingest/dataset/layout.hpp"
#include "ingest/dataset/subjects.hpp"

namespace actformer::eval {
namespace {

/// Where clips' bodies point in their first frames, added up: the axis of the largest sum is up.
void find_up(const ingest::Dataset& dataset, const ingest::BodyModel& body, MeasuredBody& to) {
    constexpr std::size_t most = 50;
    const auto parts = ingest::body_parts(body.topology.names);
    std::array<double, 3> sum{};
    const auto clips = dataset.clips().size(), step = std::max<std::size_t>(1, clips / most);
    for (std::size_t c = 0; c < clips; c += step) {
        const auto positions = ingest::joint_positions(dataset.motion(c), body);
        std::vector<std::array<double, 3>> places;
        for (std::size_t j = 0; j < body.topology.joints(); ++j)
            places.push_back({positions[3 * j], positions[3 * j + 1], positions[3 * j + 2]});
        if (const auto way = ingest::upright_direction(places, parts))
            for (std::size_t i = 0; i < 3; ++i) sum[i] += (*way)[i];
    }
    const auto larger = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const auto found = std::ranges::max_element(sum, larger);
    if (*found == 0) return;
    to.up = static_cast<std::size_t>(found - sum.begin());
    to.up_sign = *found > 0 ? 1 : -1;
}

}  // namespace

std::optional<MeasurementSetup> measurement_setup(const ingest::Dataset& dataset) {
    if (dataset.clips().empty()) return {};
    const auto subjects = ingest::subjects_of(dataset);
    const auto first = dataset.motion(0);  // what cannot be read is no motion without positions
    try {
        static_cast<void>(ingest::joint_positions(first, subjects));
    } catch (const Error&) {
        return {};
    }
    MeasurementSetup setup{subjects, {}, subjects.persons};
    setup.measured.parents = subjects.topology.parents;
    setup.measured.feet = feet_among(subjects.topology.names);
    setup.measured.fps = subjects.fps;
    find_up(dataset, subjects, setup.measured);
    return setup;
}

bool fits(const MeasurementSetup& setup, const MotionsInfo& motions) {
    const auto& how = setup.body.representation;
    return motions.representation == how && motions.joints == how.nodes(setup.body.topology) &&
           motions.channels == setup.persons * how.numbers();
}

MeasuredSource::MeasuredSource(std::unique_ptr<MotionSource> from, const MeasurementSetup& setup,
                               kernels::Device& device)
    : from_(std::move(from)), setup_(setup), device_(device) {}

MotionBatch MeasuredSource::next() {
    const auto batch = from_->next();
    if (batch.rows.empty()) return batch;
    const std::size_t one = std::size_t{info().channels} * batch.frames * info().joints;
    auto values = batch.values;
    if (batch.on_device) {
        read_back_.resize(batch.rows.size() * one);
        device_.queue().enqueueReadBuffer(*batch.on_device, CL_TRUE, 0, read_back_.size() * sizeof(float),
                                          read_back_.data());
        values = read_back_;
    }
    ingest::Motion motion;
    motion.frames = batch.frames;
    motion.persons = setup_.persons;
    motion.nodes = info().joints;
    motion.numbers = setup_.body.representation.numbers();
    motion.values.resize(one);
    for (std::size_t i = 0; i < batch.rows.size(); ++i) {
        ingest::take_channels_first(values.subspan(i * one, one), motion);
        measure(ingest::joint_positions(motion, setup_.body), batch.frames, setup_.persons, setup_.measured,
                passed_);
    }
    rows_.insert(rows_.end(), batch.rows.begin(), batch.rows.end());
    return batch;
}

MotionMeasures MeasuredSource::measures() const {
    std::vector<std::size_t> order(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) order[rows_[i]] = i;
    return subset(passed_, order);
}

}  // namespace actformer::eval
