#include "kernels/cleaning.hpp"

#include <cmath>
#include <numeric>

namespace actformer::kernels {
namespace {

/// Where each clip's frames lie, on the device.
struct FrameTable {
    FrameTable(Device& device, const ClipBatch& batch)
        : total(static_cast<std::uint32_t>(batch.total_frames())) {
        std::vector<std::uint32_t> starts{0}, owners;
        owners.reserve(total);
        for (std::uint32_t clip = 0; clip < batch.clips(); ++clip) {
            starts.push_back(starts.back() + batch.frames[clip]);
            owners.insert(owners.end(), batch.frames[clip], clip);
        }
        start = Buffer<std::uint32_t>(device, starts);
        owner = Buffer<std::uint32_t>(device, owners);
    }

    std::uint32_t total;
    Buffer<std::uint32_t> start;  ///< (clips + 1)
    Buffer<std::uint32_t> owner;  ///< (frames) clip of each
};

LimbRows fill_gaps(Device& device, const ClipBatch& batch, const FrameTable& table,
                   const Buffer<float>& limbs) {
    const std::uint32_t numbers = batch.joints * 3, chunks = (numbers + 15) / 16;
    const std::uint32_t rows = table.total * batch.persons;
    const Buffer<float> times(device, batch.times), step(device, batch.step);
    const Buffer<std::uint32_t> first(device, batch.first);
    const Buffer<cl_uint2> pair(device, rows);
    const Buffer<float> weight(device, rows);
    LimbRows out{Buffer<float>(device, std::size_t{rows} * chunks * 16), chunks * 16};

    launch(device, device.kernel("fill_gaps", "locate"), {batch.persons, table.total}, times, first,
           table.start, step, table.owner, pair, weight, batch.persons, table.total);
    launch(device, device.kernel("fill_gaps", "blend"), {chunks, rows}, limbs, pair, weight, out.values,
           numbers, rows);
    return out;
}

/// Centre and right half of a Gaussian that sums to one over 2 * radius + 1 frames.
std::vector<float> gaussian(const Smoothing& how) {
    std::vector<double> taps(how.radius + 1);
    for (std::size_t r = 0; r < taps.size(); ++r)
        taps[r] = std::exp(-0.5 * static_cast<double>(r * r) / (double{how.sigma} * how.sigma));
    const double sum = 2 * std::accumulate(taps.begin(), taps.end(), 0.0) - taps[0];
    std::vector<float> out(taps.size());
    for (std::size_t r = 0; r < taps.size(); ++r) out[r] = static_cast<float>(taps[r] / sum);
    return out;
}

LimbRows smooth(Device& device, const ClipBatch& batch, const FrameTable& table, const LimbRows& limbs,
                const Smoothing& how) {
    if (how.sigma <= 0) return limbs;
    const std::uint32_t chunks = batch.persons * limbs.pitch / 16;
    const Buffer<float> taps(device, gaussian(how));
    LimbRows out{Buffer<float>(device, limbs.values.size()), limbs.pitch};
    launch(device, device.kernel("smooth", "smooth"), {chunks, table.total}, taps, table.start, table.owner,
           limbs.values, out.values, how.radius, chunks, table.total);
    return out;
}

CleanedBatch normalise(Device& device, const ClipBatch& batch, const FrameTable& table,
                       const LimbRows& limbs) {
    const auto sequences = static_cast<std::uint32_t>(batch.clips()) * batch.persons;
    const std::uint32_t rows = table.total * batch.persons;
    const Buffer<float> bones(device, std::size_t{sequences} * batch.joints);
    const Buffer<cl_float4> roots(device, sequences);
    const Buffer<float> motion(device, std::size_t{rows} * batch.joints * 3);

    launch(device, device.kernel("normalise", "means"), {batch.joints, sequences}, limbs.values, table.start,
           bones, roots, batch.persons, batch.joints, limbs.pitch, sequences);
    launch(device, device.kernel("normalise", "unit_limbs"), {batch.joints, rows}, limbs.values, table.owner,
           roots, motion, batch.persons, batch.joints, limbs.pitch, rows);
    return {motion.download(), bones.download()};
}

}  // namespace

std::size_t ClipBatch::total_frames() const {
    return std::accumulate(frames.begin(), frames.end(), std::size_t{0});
}

LimbRows fill_gaps(Device& device, const ClipBatch& batch, const Buffer<float>& limbs) {
    return fill_gaps(device, batch, FrameTable(device, batch), limbs);
}

LimbRows smooth(Device& device, const ClipBatch& batch, const LimbRows& limbs, const Smoothing& how) {
    return smooth(device, batch, FrameTable(device, batch), limbs, how);
}

CleanedBatch normalise(Device& device, const ClipBatch& batch, const LimbRows& limbs) {
    return normalise(device, batch, FrameTable(device, batch), limbs);
}

CleanedBatch clean(Device& device, const ClipBatch& batch, const Buffer<float>& limbs, const Smoothing& how) {
    const FrameTable table(device, batch);
    return normalise(device, batch, table,
                     smooth(device, batch, table, fill_gaps(device, batch, table, limbs), how));
}

}  // namespace actformer::kernels
