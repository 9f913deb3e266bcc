// Real clips (Bandai-Namco-Research-Motiondataset-1, where it is at hand) from archive to cleaned motion,
// against a reader and a forward kinematics written once more, plainly and in double precision.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "ingest/formats/bvh/bvh_format.hpp"
#include "ingest/pipeline/source.hpp"
#include "tests/support/collected.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/rounds.hpp"

namespace actformer::ingest {
namespace {

using test::Collected;

using Matrix = std::array<std::array<double, 4>, 4>;

Matrix identity() {
    Matrix m{};
    for (int i = 0; i < 4; ++i) m[i][i] = 1;
    return m;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix m{};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            for (int k = 0; k < 4; ++k) m[i][j] += a[i][k] * b[k][j];
    return m;
}

Matrix rotation(char axis, double degrees) {
    const double angle = degrees * std::acos(-1.0) / 180, c = std::cos(angle), s = std::sin(angle);
    const int u = axis == 'X' ? 1 : axis == 'Y' ? 2 : 0, v = (u + 1) % 3;
    Matrix m = identity();
    m[u][u] = m[v][v] = c;
    m[u][v] = -s;
    m[v][u] = s;
    return m;
}

struct PlainJoint {
    std::string name;
    std::array<double, 3> offset{};
    std::vector<std::string> channels;
    std::vector<PlainJoint> children;
};

PlainJoint read_joint(std::istream& in) {
    PlainJoint joint;
    std::string word;
    in >> joint.name >> word;  // name and {
    while (in >> word && word != "}") {
        if (word == "OFFSET") {
            for (auto& o : joint.offset) in >> o;
        } else if (word == "CHANNELS") {
            std::size_t count = 0;
            in >> count;
            joint.channels.resize(count);
            for (auto& c : joint.channels) in >> c;
        } else {  // JOINT or End
            joint.children.push_back(read_joint(in));
        }
    }
    return joint;
}

struct PlainClip {
    PlainJoint root;
    std::vector<std::array<double, 3>> positions;  ///< (frames, joints), end sites apart
    std::size_t joints = 0, frames = 0;
};

void place(const PlainJoint& joint, const Matrix& parent, std::istream& in,
           std::vector<std::array<double, 3>>& positions) {
    if (joint.name == "Site") return;
    std::array<double, 3> at = joint.offset;
    Matrix turned = identity();
    for (const auto& channel : joint.channels) {
        double value = 0;
        in >> value;
        if (channel.substr(1) == "position")
            at[channel[0] - 'X'] = value;
        else
            turned = turned * rotation(channel[0], value);
    }
    Matrix moved = identity();
    for (int d = 0; d < 3; ++d) moved[d][3] = at[d];
    const Matrix world = parent * moved * turned;
    positions.push_back({world[0][3], world[1][3], world[2][3]});
    for (const auto& child : joint.children) place(child, world, in, positions);
}

PlainClip read_plainly(std::string_view text) {
    std::istringstream in{std::string(text)};
    std::string word;
    PlainClip clip;
    in >> word >> word;  // HIERARCHY ROOT
    clip.root = read_joint(in);
    in >> word >> word >> clip.frames >> word >> word >> word;  // MOTION Frames: n Frame Time: t
    for (std::size_t f = 0; f < clip.frames; ++f) place(clip.root, identity(), in, clip.positions);
    EXPECT_TRUE(in) << "the plain reader is at fault";
    clip.joints = clip.positions.size() / clip.frames;
    return clip;
}

/// Joint `j` of the dataset is joint j + 1 of the file, whose first, on the floor, is left out.
void expect_agreement(const PlainClip& clip, const Topology& topology, const kernels::CleanedBatch& got) {
    const std::size_t joints = topology.joints();
    ASSERT_EQ(clip.joints, joints + 1);
    ASSERT_EQ(got.motion.size(), clip.frames * joints * 3);
    std::array<double, 3> mean{};
    for (std::size_t f = 0; f < clip.frames; ++f)
        for (int d = 0; d < 3; ++d)
            mean[d] += 0.01 * clip.positions[f * clip.joints + 1][d] / static_cast<double>(clip.frames);
    std::vector<double> bones(joints, 0);
    for (std::size_t f = 0; f < clip.frames; ++f)
        for (std::size_t j = 0; j < joints; ++j) {
            const auto& joint = clip.positions[f * clip.joints + j + 1];
            std::array<double, 3> want{};
            if (j == 0) {
                for (int d = 0; d < 3; ++d) want[d] = 0.01 * joint[d] - mean[d];
            } else {
                const auto& parent = clip.positions[f * clip.joints + topology.parents[j] + 1];
                for (int d = 0; d < 3; ++d) want[d] = 0.01 * (joint[d] - parent[d]);
                const double length = std::hypot(want[0], want[1], want[2]);
                for (auto& w : want) w /= length + 1e-4;
                bones[j] += length / static_cast<double>(clip.frames);
            }
            for (int d = 0; d < 3; ++d)
                ASSERT_NEAR(got.motion[(f * joints + j) * 3 + d], want[d], 1e-5)
                    << "frame " << f << " joint " << j;
        }
    for (std::size_t j = 0; j < joints; ++j) ASSERT_NEAR(got.bone_length[j], bones[j], 1e-5) << "joint " << j;
}

void survey(BvhFormat& format, const std::filesystem::path& archive) {
    Source source({archive}, format.extensions());
    std::vector<char> scratch;
    for (RawFile file; source.next(file);) format.survey(file.raw(file.text(scratch)));
    format.settle();
}

TEST(BvhBnr, RealClipsComeOutAsPlainDoublePrecisionHasThem) {
    const std::filesystem::path archive = test::shared("data/bnr/dataset-1.tar.xz");
    if (!std::filesystem::exists(archive)) GTEST_SKIP() << archive << " is not at hand";
    BvhOptions options;
    options.dataset = "bnr-1";
    options.pattern = "dataset-1_{action}_{style}_{index}";
    BvhFormat format(options);
    survey(format, archive);
    const auto& header = format.datasets()[0];
    EXPECT_EQ(header.topology.names[0], "Hips");
    EXPECT_EQ(header.topology.joints(), 21U);
    EXPECT_EQ(header.fps, 30);
    EXPECT_EQ(header.classes.size(), 16U);

    kernels::Device device;
    Source source({archive}, format.extensions());
    std::vector<char> scratch;
    std::size_t files = 0;
    constexpr std::size_t every = test::sanitized ? 40 : 8;
    for (RawFile file; source.next(file);) {
        if (files++ % every != 0) continue;
        SCOPED_TRACE(file.path);
        const auto text = file.text(scratch);
        Collected out;
        format.read(file.raw(text), out);
        ASSERT_EQ(out.clips.size(), 1U);
        if (auto* r = std::get_if<Rejection>(&out.clips[0])) FAIL() << r->reason;
        std::vector<std::unique_ptr<RawClip>> clips;
        clips.push_back(std::get<std::unique_ptr<RawClip>>(std::move(out.clips[0])));
        std::vector<std::uint32_t> frames;
        expect_agreement(read_plainly(text), header.topology, format.clean(device, 0, clips, frames));
        if (HasFatalFailure()) return;
    }
    EXPECT_EQ(files, 174U);
}

}  // namespace
}  // namespace actformer::ingest
