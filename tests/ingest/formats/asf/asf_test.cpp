// Acclaim's skeletons and motions: against closed forms, against a second forward kinematics where CMU's files are at hand, and on
// what is hostile.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "base/numpy/npz.hpp"
#include "ingest/formats/asf/amc_file.hpp"
#include "ingest/formats/skeletal/pose.hpp"
#include "tests/support/command.hpp"
#include "tests/support/larger.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::ingest {
namespace {

using test::replaced;

/// The text with the zero bytes that readers may load, and not one more.
class Padded {
  public:
    explicit Padded(const std::string& text) : bytes_(text.begin(), text.end()), size_(text.size()) {
        bytes_.resize(size_ + 64);
    }
    std::string_view view() const { return {bytes_.data(), size_}; }

  private:
    std::vector<char> bytes_;
    std::size_t size_;
};

template <typename Result>
std::string reason_of(const Result& result) {
    const auto* rejection = std::get_if<Rejection>(&result);
    return rejection ? rejection->reason : "taken";
}

AsfSkeleton skeleton_of(const std::string& text) {
    auto result = parse_asf(Padded(text).view());
    EXPECT_EQ(reason_of(result), "taken");
    return std::holds_alternative<AsfSkeleton>(result) ? std::get<AsfSkeleton>(std::move(result))
                                                       : AsfSkeleton();
}

std::string why_no_skeleton(const std::string& text) {
    return reason_of(parse_asf(Padded(text).view()));
}

Recording recording_of(const std::string& text, const AsfSkeleton& skeleton) {
    auto result = parse_amc(Padded(text).view(), skeleton);
    EXPECT_EQ(reason_of(result), "taken");
    return std::holds_alternative<Recording>(result) ? std::get<Recording>(std::move(result)) : Recording();
}

/// A back that goes up 2, a hip bone that cannot turn, and a thigh whose own axes are turned by a right angle about z: what it calls
/// x is the world's y.
const std::string asf =
    "# made by hand\n:version 1.10\n:name T\n:units\n  mass 1.0\n  length 0.45\n  angle "
    "deg\n:documentation\n  any text { here\n"
    ":root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n  position 0 0 0\n  orientation 0 0 0\n"
    ":bonedata\n"
    "  begin\n    id 1\n    name hip\n    direction 0 -1 0\n    length 1\n    axis 0 0 0 XYZ\n  end\n"
    "  begin\n    id 2\n    name thigh\n    direction 0 -1 0\n    length 4\n    axis 0 0 90 XYZ\n    dof rx "
    "ry\n"
    "    limits (-160.0 20.0)\n           (-70.0 70.0)\n  end\n"
    "  begin\n    id 3\n    name back\n    direction 0 1 0\n    length 2\n    axis 0 0 0 XYZ\n    dof rz\n   "
    " limits (-1 1)\n  end\n"
    ":hierarchy\n  begin\n    root back hip\n    hip thigh\n  end\n";  // joints run back, hip, thigh

const std::string amc =
    "#!OML:ASF made by hand\n:FULLY-SPECIFIED\n:DEGREES\n"
    "1\nroot 10 20 30 0 0 0\nback 0\nthigh 0 0\n"
    "2\nroot 11 20 30 0 90 0\nback 90\nthigh 90 0\n"
    "3\nroot 11 20 30 0 0 0\nthigh 0 90\nback 0\n";

void expect_place(const Vector3& got, const Vector3& want) {
    for (std::size_t d = 0; d < 3; ++d)
        EXPECT_NEAR(got[d], want[d], 1e-5) << d;  // angles are float32 degrees
}

TEST(AsfFile, ReadsBonesInTheHierarchysOrder) {
    const auto skeleton = skeleton_of(asf);
    ASSERT_EQ(skeleton.bones.size(), 3U);
    EXPECT_EQ(skeleton.bones[0].name, "back");
    EXPECT_EQ(skeleton.bones[1].name, "hip");
    EXPECT_EQ(skeleton.bones[2].name, "thigh");
    EXPECT_EQ(skeleton.bones[2].parent, 1);
    EXPECT_EQ(skeleton.bones[0].parent, -1);
    EXPECT_EQ(skeleton.bones[2].stick, (Vector3{0, -4, 0}));
    EXPECT_EQ(skeleton.root_channels.size(), 6U);
    EXPECT_EQ(skeleton.radians_to_degrees, 1);
}

TEST(AmcFile, BonesTurnAboutTheirOwnAxes) {
    const auto recording = recording_of(amc, skeleton_of(asf));
    EXPECT_EQ(recording.frames, 3U);
    EXPECT_EQ(recording.fps(), 120);
    EXPECT_EQ(recording.origin, (std::array<double, 3>{10, 20, 30}));
    std::map<std::string, std::size_t> joint;
    for (std::size_t j = 0; j < recording.joints.size(); ++j)
        if (!recording.joints[j].pivot) joint[recording.joints[j].name] = j;
    ASSERT_EQ(joint.size(), 4U);
    const auto first = places_of(recording, 0), second = places_of(recording, 1),
               third = places_of(recording, 2);
    expect_place(first[joint["root"]], {0, 0, 0});
    expect_place(first[joint["back"]], {0, 2, 0});
    expect_place(first[joint["thigh"]], {0, -5, 0});
    // The world turns about y, taking x to -z. The back turns about z, from y to -x, which is z there. The thigh turns about the
    // world's y, along which it lies: nothing shows.
    expect_place(second[joint["root"]], {1, 0, 0});
    expect_place(second[joint["back"]], {1, 0, 2});
    expect_place(second[joint["thigh"]], {1, -5, 0});
    // The thigh's y is the world's -x, about which -y goes to z.
    expect_place(third[joint["hip"]], {1, -1, 0});
    expect_place(third[joint["thigh"]], {1, -1, 4});
}

TEST(AmcFile, TakesRadiansAndOtherOrders) {
    const auto skeleton = skeleton_of(replaced(asf, "order TX TY TZ RX RY RZ", "order RZ RY RX TZ TY TX"));
    const auto degrees = recording_of(amc, skeleton_of(asf));
    const auto radians = recording_of(
        ":RADIANS\n1\nroot 0 0 0 30 20 10\nback 0\nthigh 0 0\n"
        "2\nroot 0 1.5707963267948966 0 30 20 11\nback 1.5707963267948966\nthigh 1.5707963267948966 0\n",
        skeleton);
    ASSERT_EQ(radians.joints.size(), degrees.joints.size());
    const auto got = places_of(radians, 1), want = places_of(degrees, 1);
    for (std::size_t j = 0; j < got.size(); ++j) expect_place(got[j], want[j]);
    EXPECT_NEAR(skeleton_of(replaced(asf, "angle deg", "angle rad")).radians_to_degrees, 57.29577951308232,
                1e-12);
}

TEST(AsfFile, RefusesWhatIsMalformed) {
    EXPECT_EQ(why_no_skeleton(""), "line 1: no :root section with an order; is this an .asf file?");
    EXPECT_EQ(why_no_skeleton("HIERARCHY\nROOT x\n"),
              "line 1: 'HIERARCHY' in place of a section, as in :root; is this an .asf file?");
    EXPECT_EQ(why_no_skeleton(asf.substr(0, asf.find(":bonedata"))),
              "line 15: no bone in a :bonedata section");
    EXPECT_EQ(why_no_skeleton(asf.substr(0, asf.find(":hierarchy"))),
              "line 42: no bone hangs at the root in a :hierarchy section");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "hip thigh", "hip shin")),
              "line 45: no bone 'shin' in :bonedata");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "hip thigh", "hip thigh back")),
              "line 45: bone 'back' has a parent already");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "name thigh", "name hip")), "line 32: a second bone 'hip'");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "    name hip\n", "")), "line 21: a bone without a name");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "dof rx ry", "dof rx tx")),
              "line 29: bone 'thigh' slides along 'tx'; only bones that turn can be read");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "dof rx ry", "dof rx rx")), "line 29: 'rx' twice");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "dof rx ry", "dof rx l")),
              "line 29: 'l' in place of TX, TY, TZ, RX, RY or RZ");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "axis 0 0 90 XYZ", "axis 0 0 90 XYY")),
              "line 28: 'XYY' in place of an order of axes, as in XYZ");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "length 4", "length four")),
              "line 27: 'four' in place of a length");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "length 4", "length 1e9")),
              "line 27: '1e9' is too large for a length");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "angle deg", "angle grad")),
              "line 7: angles in 'grad', not deg or rad");
    EXPECT_EQ(why_no_skeleton(replaced(asf, "  begin\n    id 2", "    id 2")),
              "line 23: 'id' in place of begin");
}

TEST(AmcFile, RefusesWhatIsMalformed) {
    const auto skeleton = skeleton_of(asf);
    const auto why = [&](const std::string& text) {
        return reason_of(parse_amc(Padded(text).view(), skeleton));
    };
    EXPECT_EQ(why(""), "line 1: no frame; is this an .amc file?");
    EXPECT_EQ(why("HIERARCHY\n"), "line 1: 'HIERARCHY' in place of a frame's number");
    EXPECT_EQ(why(replaced(amc, "2\nroot", "3\nroot")), "line 8: frame 3 follows frame 1");
    EXPECT_EQ(why(replaced(amc, "back 90\n", "")), "line 8: frame 2 has no numbers of 'back'");
    EXPECT_EQ(why(replaced(amc, "back 90\n", "back 90\nback 90\n")), "line 11: 'back' twice in frame 2");
    EXPECT_EQ(why(replaced(amc, "back 90\n", "back 90 1\n")), "line 10: more than the 1 numbers of 'back'");
    EXPECT_EQ(why(replaced(amc, "back 90\n", "back\n")), "line 10: 0 numbers of 'back', not 1");
    EXPECT_EQ(why(replaced(amc, "back 90\n", "neck 90\n")), "line 10: the skeleton has no bone 'neck'");
    EXPECT_EQ(why(replaced(amc, "back 90\n", "back nan\n")), "line 10: 'nan' in place of a number");
    EXPECT_EQ(why(amc.substr(0, amc.size() - 7)), "line 12: frame 3 has no numbers of 'back'");
}

TEST(AmcFile, NamesALineForEveryTruncation) {
    const auto skeleton = skeleton_of(asf);
    for (std::size_t size = 0; size < amc.size(); ++size) {
        const auto why = reason_of(parse_amc(Padded(amc.substr(0, size)).view(), skeleton));
        ASSERT_TRUE(why == "taken" || why.starts_with("line ")) << size << ": " << why;
    }
    for (std::size_t size = 0; size < asf.size(); ++size) {
        const auto why = why_no_skeleton(asf.substr(0, size));
        ASSERT_TRUE(why == "taken" || why.starts_with("line ")) << size << ": " << why;
    }
}

/// CMU's file, read once more and plainly, without a turn about anything but a bone's own axes: global rotation times the bone's
/// axes, its turns and its axes back.
class PlainAcclaim {
  public:
    explicit PlainAcclaim(const std::string& text) {
        std::istringstream in(text);
        std::string word;
        Bone bone;
        while (in >> word && word != ":hierarchy") {
            if (word == "begin") bone = {};
            if (word == "name") in >> bone.name;
            if (word == "direction") in >> bone.direction[0] >> bone.direction[1] >> bone.direction[2];
            if (word == "length") in >> bone.length;
            if (word == "axis" && !bone.name.empty()) in >> bone.axis[0] >> bone.axis[1] >> bone.axis[2];
            if (word == "dof") {
                std::getline(in, word);
                std::istringstream dofs(word);
                while (dofs >> word) bone.dofs.push_back(word[1] - 'x');
            }
            if (word == "end") bones_[bone.name] = bone;
        }
        std::string line;
        while (std::getline(in, line)) {
            std::istringstream words(line);
            std::string parent;
            words >> parent;
            while (words >> word)
                if (parent != "begin" && parent != "end") bones_[word].parent = parent;
        }
    }

    /// Ends of bones by name, of a frame's numbers by name.
    std::map<std::string, std::array<double, 3>> place(
        const std::map<std::string, std::vector<double>>& frame) const {
        std::map<std::string, std::array<double, 3>> places;
        std::map<std::string, M> turns;
        const auto& root = frame.at("root");
        places["root"] = {root[0], root[1], root[2]};
        turns["root"] = product(about(2, root[5]), product(about(1, root[4]), about(0, root[3])));
        while (places.size() <= bones_.size())
            for (const auto& [name, bone] : bones_)
                if (!places.contains(name) && places.contains(bone.parent))
                    put(name, bone, frame, places, turns);
        return places;
    }

  private:
    using M = std::array<std::array<double, 3>, 3>;
    struct Bone {
        std::string name, parent;
        std::array<double, 3> direction{}, axis{};
        double length = 0;
        std::vector<int> dofs;
    };

    static M about(int axis, double degrees) {
        const double a = degrees * std::acos(-1.0) / 180, c = std::cos(a), s = std::sin(a);
        if (axis == 0) return {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
        if (axis == 1) return {{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
        return {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
    }
    static M product(const M& a, const M& b) {
        M m{};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k) m[i][j] += a[i][k] * b[k][j];
        return m;
    }

    static void put(const std::string& name, const Bone& bone,
                    const std::map<std::string, std::vector<double>>& frame,
                    std::map<std::string, std::array<double, 3>>& places, std::map<std::string, M>& turns) {
        const M axes =
            product(about(2, bone.axis[2]), product(about(1, bone.axis[1]), about(0, bone.axis[0])));
        M back{};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) back[i][j] = axes[j][i];
        M turn = about(0, 0);
        for (std::size_t d = 0; d < bone.dofs.size(); ++d)
            turn = product(about(bone.dofs[d], frame.at(name)[d]), turn);
        const M world = product(turns[bone.parent], product(axes, product(turn, back)));
        auto end = places[bone.parent];
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) end[i] += bone.length * world[i][j] * bone.direction[j];
        places[name] = end;
        turns[name] = world;
    }

    std::map<std::string, Bone> bones_;
};

TEST(AmcFile, RealFilesComeOutAsPlainDoublePrecisionHasThem) {
    const std::filesystem::path archive = test::shared("data/cmu_bvh/cmu_bvh.tar.xz");
    if (!std::filesystem::exists(archive)) GTEST_SKIP() << archive << " is not at hand";
    const test::TempDir dir;
    ASSERT_EQ(
        test::run_command("tar -xJf " + archive.string() + " -C " + dir.path().string() + " asfamc").exit, 0);
    const auto skeleton_text = test::read_file(dir / "asfamc/49.asf"),
               text = test::read_file(dir / "asfamc/49_18.amc");
    const auto recording = recording_of(text, skeleton_of(skeleton_text));
    const PlainAcclaim plain(skeleton_text);

    std::istringstream in(text);
    std::string line;
    while (std::getline(in, line) && line[0] != '1') {
    }
    std::uint32_t frame = 0;
    double worst = 0;
    while (in) {
        std::map<std::string, std::vector<double>> numbers;
        while (std::getline(in, line) && std::isalpha(static_cast<unsigned char>(line[0]))) {
            std::istringstream words(line);
            std::string name;
            words >> name;
            for (double value = 0; words >> value;) numbers[name].push_back(value);
        }
        if (frame % 50 == 0) {
            const auto want = plain.place(numbers);
            const auto got = places_of(recording, frame);
            for (std::size_t j = 0; j < got.size(); ++j) {
                if (recording.joints[j].pivot) continue;
                const auto& place = want.at(recording.joints[j].name);
                for (std::size_t d = 0; d < 3; ++d)
                    worst = test::larger(worst, std::abs(got[j][d] + recording.origin[d] - place[d]));
            }
        }
        ++frame;
    }
    EXPECT_EQ(frame, recording.frames);
    EXPECT_LT(worst, 2e-5);  // of bodies 30 units tall, turned by float32 degrees
}

// The layouts share the path of the root: AMASS's z is up, in metres, rounded to 1e-5; an Acclaim unit is 1/0.45 inch. No trial at hand
// is both AMC and BVH.
TEST(AmcFile, RootsAreThoseOfTheSameTrialInAmassLayout) {
    const std::filesystem::path acclaim = test::shared("data/cmu_bvh/cmu_bvh.tar.xz"),
                                amass = test::shared("data/cmu_amass/CMU.tar.xz");
    if (!std::filesystem::exists(acclaim) || !std::filesystem::exists(amass))
        GTEST_SKIP() << acclaim << " or " << amass << " is not at hand";
    const test::TempDir dir;
    for (const auto& archive : {acclaim, amass})
        ASSERT_EQ(test::run_command("tar -xJf " + archive.string() + " -C " + dir.path().string() +
                                    " --wildcards '*35.asf' '*49.asf' '*35_01*' '*49_18*' '*49_20*' 2>" +
                                    (dir / "not_there").string() + "; true")
                      .exit,
                  0);
    constexpr double unit = 0.0254 / 0.45;
    for (const std::string trial : {"35_01", "49_18", "49_20"}) {
        const auto subject = trial.substr(0, 2);
        const auto recording =
            recording_of(test::read_file(dir / ("asfamc/" + trial + ".amc")),
                         skeleton_of(test::read_file(dir / ("asfamc/" + subject + ".asf"))));
        std::vector<double> path;
        double rate = 0;
        const auto npz = test::read_file(dir / ("CMU/" + subject + "/" + trial + "_poses.npz"));
        read_npz(
            npz,
            {.wanted = [](const std::string& name) { return name == "trans" || name == "mocap_framerate"; }},
            [&](const std::string& name, const NumpyArray& array) {
                const auto values = array.all_numbers();
                if (name == "trans")
                    path = values;
                else
                    rate = values.at(0);
            });
        const auto every = static_cast<std::uint32_t>(std::lround(120 / rate));
        ASSERT_EQ(path.size() / 3, (recording.frames + every - 1) / every) << trial;
        double worst = 0;
        for (std::uint32_t t = 0; t < path.size() / 3; ++t) {
            auto root = places_of(recording, t * every)[0];
            for (std::size_t d = 0; d < 3; ++d) root[d] = unit * (root[d] + recording.origin[d]);
            const std::array<double, 3> upright{root[0], -root[2], root[1]};
            for (std::size_t d = 0; d < 3; ++d)
                worst = test::larger(worst, std::abs(upright[d] - path[3 * t + d]));
        }
        EXPECT_LT(worst, 6e-6) << trial;
    }
}

}  // namespace
}  // namespace actformer::ingest
