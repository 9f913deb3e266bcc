// Datasets written without raw data, in any representation, small enough to train on in a test.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/files/file.hpp"
#include "ingest/dataset/dataset_json.hpp"
#include "ingest/dataset/shard.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::test {

/// A clip and the lengths of its limbs (persons, joints).
struct MadeClip {
    ingest::Clip clip;
    ingest::Motion motion;
    std::vector<float> bone_length;
};

/// A dataset of one shard in `folder`.
inline void write_dataset(const std::filesystem::path& folder, const ingest::DatasetHeader& header,
                          const std::vector<MadeClip>& clips) {
    ingest::ShardBuilder shard(header);
    for (const auto& made : clips) {
        kernels::CleanedBatch cleaned;
        cleaned.motion = made.motion.values;
        cleaned.bone_length = made.bone_length;
        auto clip = made.clip;
        clip.name = made.motion.name;
        clip.frames = made.motion.frames;
        shard.add({clip}, std::move(cleaned));
    }
    ingest::ShardEntry entry{ingest::shard_name(0), {}, 0, shard.clips(), shard.frames()};
    std::filesystem::create_directories(folder);
    hdf5::FileMemory memory;
    const auto image = shard.image(memory, "made by a test", "none");
    write_whole(folder / entry.file, image.bytes);
    entry.checksum = image.contents;
    entry.metadata = image.metadata;
    entry.bytes = image.bytes.size();
    write_whole(folder / "dataset.json", ingest::to_text({header, "made by a test", "none", {entry}, {}}));
}

/// Three arms of two bones on a root that walks along z and turns about y; arm `label` swings about x. Known in closed form, so that
/// every representation tells the same motion.
class ArmsClip {
  public:
    static constexpr std::size_t joints = 7;
    static constexpr std::array<std::array<float, 3>, joints> rest{{{0, 0.1F, 0},
                                                                    {0.3F, 0, 0},
                                                                    {0, -0.3F, 0},
                                                                    {-0.3F, 0, 0},
                                                                    {0, -0.3F, 0},
                                                                    {0, 0.4F, 0},
                                                                    {0, 0.2F, 0.1F}}};

    static const ingest::Topology& topology() {
        static const ingest::Topology tree{{"root", "a", "a end", "b", "b end", "c", "c end"},
                                           {-1, 0, 1, 0, 3, 0, 5}};
        return tree;
    }

    ArmsClip(std::uint32_t label, std::uint32_t index, std::uint32_t frames)
        : label_(label), index_(index), frames_(frames) {}

    ingest::Motion in(ingest::Representation how) const {
        ingest::Motion motion{
            fmt::format("c{}_{}", label_, index_), frames_, 1, how.nodes(topology()), how.numbers(), {}};
        for (std::uint32_t t = 0; t < frames_; ++t) {
            const auto add = [&](const std::vector<double>& values) {
                for (const auto x : values) motion.values.push_back(static_cast<float>(x));
            };
            if (how == ingest::Representation::rot6d) add(rotations(t));
            if (how == ingest::Representation::xyz) add(positions(t));
            if (how == ingest::Representation::limb) add(limbs(t));
        }
        return motion;
    }

    std::vector<float> bone_length() const {
        std::vector<float> out{0};
        for (std::size_t j = 1; j < joints; ++j)
            out.push_back(std::hypot(rest[j][0], rest[j][1], rest[j][2]));
        return out;
    }

    /// (joints, 3), in closed form: a joint's rotation is one about y (the root's), then one about x (its arm's).
    std::vector<double> positions(std::uint32_t t) const {
        std::vector<double> at(joints * 3);
        for (std::size_t j = 0; j < joints; ++j) {
            const auto parent = static_cast<std::size_t>(std::max(0, topology().parents[j]));
            const auto offset =
                j == 0 ? turned(0, 0, rest[j]) : turned(yaw(t), parent == 0 ? 0 : swing(t, parent), rest[j]);
            for (std::size_t d = 0; d < 3; ++d)
                at[j * 3 + d] = offset[d] + (j == 0 ? translation(t)[d] : at[parent * 3 + d]);
        }
        return at;
    }

  private:
    double phase() const { return 0.7 * index_; }
    double yaw(std::uint32_t t) const { return 0.5 * std::sin(0.05 * t + phase()); }
    std::array<double, 3> translation(std::uint32_t t) const {
        return {0.1 * std::sin(0.1 * t), 0.9, 0.02 * (t - 0.5 * (frames_ - 1.0))};
    }
    double swing(std::uint32_t t, std::size_t joint) const {
        return joint == 2 * label_ + 1 ? 1.2 * std::sin((0.2 + 0.01 * (index_ % 5)) * t + phase())
                                       : 0.02 * index_;
    }

    /// Ry(yaw) Rx(swing) v
    static std::array<double, 3> turned(double yaw, double swing, const std::array<float, 3>& v) {
        const double y = std::cos(swing) * v[1] - std::sin(swing) * v[2],
                     z = std::sin(swing) * v[1] + std::cos(swing) * v[2];
        return {std::cos(yaw) * v[0] + std::sin(yaw) * z, y, -std::sin(yaw) * v[0] + std::cos(yaw) * z};
    }

    std::vector<double> rotations(std::uint32_t t) const {
        std::vector<double> out;
        const auto add = [&](std::array<double, 6> six) { out.insert(out.end(), six.begin(), six.end()); };
        add({std::cos(yaw(t)), 0, std::sin(yaw(t)), 0, 1, 0});
        for (std::size_t j = 1; j < joints; ++j) {
            const double angle = j % 2 == 1 ? swing(t, j) : 0;
            add({1, 0, 0, 0, std::cos(angle), -std::sin(angle)});
        }
        const auto at = translation(t);
        add({at[0], at[1], at[2], 0, 0, 0});
        return out;
    }

    std::vector<double> limbs(std::uint32_t t) const {
        const auto at = positions(t);
        auto out = at;
        for (std::size_t j = 1; j < joints; ++j) {
            const auto parent = static_cast<std::size_t>(topology().parents[j]);
            double length = 0;
            for (std::size_t d = 0; d < 3; ++d) {
                out[j * 3 + d] = at[j * 3 + d] - at[parent * 3 + d];
                length += out[j * 3 + d] * out[j * 3 + d];
            }
            for (std::size_t d = 0; d < 3; ++d) out[j * 3 + d] /= std::sqrt(length) + 1e-4;
        }
        return out;
    }

    std::uint32_t label_, index_, frames_;
};

/// Clips of three classes in a representation, made once for all tests: 12 each in split s/train, 4 in s/test.
inline const std::filesystem::path& arms_in(ingest::Representation how) {
    static const TempDir dir;
    static std::map<std::string, std::filesystem::path> made;
    auto& folder = made[how.name()];
    if (!folder.empty()) return folder;
    folder = dir / how.name();
    ingest::DatasetHeader header;
    header.name = "arms-" + how.name();
    header.representation = how;
    header.topology = ArmsClip::topology();
    if (how == ingest::Representation::rot6d)
        for (const auto& offset : ArmsClip::rest)
            header.rest.insert(header.rest.end(), offset.begin(), offset.end());
    header.centre_windows = true;
    header.classes = {"c0", "c1", "c2"};
    header.fields = {"part"};
    header.splits = {{"s/train", {{"part", {"a"}, false}}}, {"s/test", {{"part", {"b"}, false}}}};
    std::vector<MadeClip> clips;
    for (std::uint32_t label = 0; label < 3; ++label)
        for (std::uint32_t i = 0; i < 16; ++i) {
            const ArmsClip clip(label, i, 40);
            clips.push_back({{"", label, 0, 0, 0, {i < 12 ? "a" : "b"}}, clip.in(how), clip.bone_length()});
        }
    write_dataset(folder, header, clips);
    return folder;
}

}  // namespace actformer::test
