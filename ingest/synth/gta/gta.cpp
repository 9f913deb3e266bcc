#include "ingest/synth/gta/gta.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/hdf5/writer.hpp"
#include "base/threads/parallel.hpp"
#include "ingest/synth/folder.hpp"
#include "ingest/synth/performer/play.hpp"
#include "ingest/synth/programmes/fights.hpp"

namespace actformer::ingest::synth {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::size_t, 4> group_sizes{2, 3, 4, 5};
constexpr std::array<double, 4> shares{0.33, 0.28, 0.22,
                                       0.17};  // as published: about 2.3, 1.9, 1.5 and 1.2 thousand
constexpr double apart = 3.2;                  // metres between pairs, who do not meet

using GtaTrack = std::vector<GtaPlaces>;

constexpr std::size_t shortest = 66;  // frames: a window of the public tools and a little more

/// Everybody in a programme, turned by `heading` and moved by `way`.
std::vector<GtaTrack> played(const Programme& programme, const std::vector<std::uint64_t>& key,
                             Random& random, double heading, const Vec& way) {
    Casting casting{key, {}};
    for (int p = 0; p < programme.persons; ++p)
        casting.cast.push_back({gta_body(), static_cast<std::uint64_t>(1 + random.below(80))});
    auto scene = play(programme, casting);
    while (scene.frames.size() < shortest) {
        ++casting.key.back();
        scene = play(programme, casting);
    }
    const auto turn = about_y(heading);
    std::vector<GtaTrack> out(static_cast<std::size_t>(scene.persons));
    for (const auto& figures : scene.frames)
        for (std::size_t p = 0; p < out.size(); ++p) {
            auto places = gta_places(figures[p]);
            if (scene.mirrored) places = mirrored(places);
            for (auto& place : places) place = turn * place + way;
            out[p].push_back(places);
        }
    return out;
}

template <typename Programmes>
const auto& one_of(const Programmes& programmes, Random& random) {
    return programmes[static_cast<std::size_t>(random.below(static_cast<int>(programmes.size())))];
}

/// (3 P, 22, T) as published.
std::vector<float> layout(const GtaClip& clip) {
    const auto persons = clip.size(), frames = clip[0].size();
    Vec mean;
    for (const auto& track : clip)
        for (const auto& places : track) mean += places[0] * (1.0 / static_cast<double>(persons * frames));
    std::vector<float> out(3 * persons * gta_joints * frames);
    for (std::size_t p = 0; p < persons; ++p)
        for (std::size_t t = 0; t < frames; ++t)
            for (std::size_t j = 0; j < gta_joints; ++j) {
                const auto& at = clip[p][t];
                Vec v = j == 0 ? at[0] - mean : at[j] - at[static_cast<std::size_t>(gta22_parents[j])];
                v = j == 0 ? Vec{0.2 * v.x, v.y, 0.2 * v.z} : v * (1 / (length(v) + 1e-4));
                const std::array<double, 3> upright{v.x, -v.z, v.y};
                for (std::size_t d = 0; d < 3; ++d)
                    out[((3 * p + d) * gta_joints + j) * frames + t] = static_cast<float>(upright[d]);
            }
    return out;
}

void write_skeleton_file(const fs::path& file) {
    std::vector<float> parent(gta_joints * gta_joints, 0), adjacency(gta_joints * gta_joints, 0), lengths;
    for (std::size_t j = 0; j < gta_joints; ++j) {
        lengths.push_back(static_cast<float>(gta_lengths[j]));
        if (gta22_parents[j] < 0) continue;
        const auto above = static_cast<std::size_t>(gta22_parents[j]);
        parent[above * gta_joints + j] = 1;
        adjacency[above * gta_joints + j] = adjacency[j * gta_joints + above] = 1;
    }
    hdf5::Writer writer(file);
    writer.write<float>("parent", {gta_joints, gta_joints}, parent);
    writer.write<float>("adjacency", {gta_joints, gta_joints}, adjacency);
    writer.write<float>("avglength", {gta_joints}, lengths);
    writer.finish();
}

}  // namespace

GtaClip gta_clip(std::size_t persons, std::uint64_t number, std::uint64_t seed) {
    Random random{seed, 0x67A, persons, number};
    GtaClip clip;
    for (std::size_t pair = 0; clip.size() < persons; ++pair) {
        const std::vector<std::uint64_t> key{seed, 0x67A1, persons, number, pair, 0};
        const bool alone = clip.size() + 1 == persons;
        const double heading = random.uniform(-180, 180);
        Vec way{apart * static_cast<double>(pair), 0, 0.5 * random.normal()};
        if (alone) way.x -= 0.9;
        auto tracks = alone
                          ? played(one_of(onlookers(), random), key, random, -90 + 25 * random.normal(), way)
                          : played(one_of(fights(), random), key, random, heading, way);
        for (auto& track : tracks) clip.push_back(std::move(track));
    }
    std::size_t frames = clip[0].size();
    for (const auto& track : clip) frames = std::min(frames, track.size());
    const auto turn = about_y(random.uniform(-180, 180));
    for (auto& track : clip) {
        track.resize(frames);
        for (auto& places : track)
            for (auto& place : places) place = turn * place;
    }
    return clip;
}

StandInSummary synthesise_gta(const StandInOptions& options) {
    claim_folder(options.folder, "actformer synth gta", options.seed);
    write_skeleton_file(options.folder / "gta_adjacency.h5");
    Counting counting(options);
    std::uint64_t left = options.clips;
    for (std::size_t g = 0; g < group_sizes.size(); ++g) {
        const auto wanted = static_cast<std::uint64_t>(shares[g] * static_cast<double>(options.clips) + 0.5);
        const auto count = g + 1 == group_sizes.size() ? left : std::min(left, wanted);
        left -= count;
        if (count == 0) continue;
        const auto persons = group_sizes[g];
        std::vector<GtaClip> clips(count);
        parallel_for(count, thread_count(options.threads), [&](std::size_t i, unsigned) {
            clips[i] = gta_clip(persons, i, options.seed);
            counting.clip_done(clips[i][0].size(), 0);
        });
        const auto file = options.folder / fmt::format("gta_combat_{}p.h5", persons);
        hdf5::Writer writer(file);
        for (std::size_t i = 0; i < count; ++i)
            writer.write<float>(fmt::format("{:05}_A001", i), {3 * persons, gta_joints, clips[i][0].size()},
                                layout(clips[i]));
        writer.finish();
        counting.add_bytes(fs::file_size(file));
    }
    return counting.summary();
}

}  // namespace actformer::ingest::synth
