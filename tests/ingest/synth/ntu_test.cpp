// Synthetic NTU clips: reproducible, well-formed, anatomically possible, with actions that differ.
#include "ingest/synth/ntu/ntu.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "ingest/dataset/topology.hpp"
#include "ingest/formats/ntu/actions.hpp"
#include "ingest/synth/ntu/kinect.hpp"
#include "ingest/synth/ntu/skeleton_writer.hpp"
#include "ingest/synth/random.hpp"
#include "tests/support/larger.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::ingest::synth {
namespace {

namespace fs = std::filesystem;

/// A second reader of the format, which accepts nothing but what the format says.
struct ParsedJoint {
    std::array<double, 11> number;
    int tracking;
};
struct ParsedBody {
    std::uint64_t id;
    std::vector<ParsedJoint> joint;
};
using ParsedClip = std::vector<std::vector<ParsedBody>>;

std::vector<std::string> fields(std::istream& in) {
    std::string line;
    if (!std::getline(in, line)) throw std::runtime_error("the text ends too soon");
    if (line.empty() || line.back() != '\r') throw std::runtime_error("no carriage return: " + line);
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
}

std::size_t count(std::istream& in) {
    const auto words = fields(in);
    if (words.size() != 1) throw std::runtime_error("a count has a line of its own");
    return std::stoul(words[0]);
}

ParsedBody parse_body(std::istream& in) {
    const auto header = fields(in);
    EXPECT_EQ(header.size(), 10u);
    ParsedBody body{std::stoull(header[0]), {}};
    EXPECT_EQ(count(in), 25u);
    for (int j = 0; j < 25; ++j) {
        const auto words = fields(in);
        EXPECT_EQ(words.size(), 12u);
        ParsedJoint joint{{}, std::stoi(words.at(11))};
        for (std::size_t i = 0; i < 11; ++i) joint.number[i] = std::stod(words.at(i));
        body.joint.push_back(joint);
    }
    return body;
}

ParsedClip parse(const std::string& text) {
    std::istringstream in(text);
    ParsedClip clip(count(in));
    for (auto& frame : clip)
        for (auto n = count(in); n > 0; --n) frame.push_back(parse_body(in));
    std::string rest;
    EXPECT_FALSE(std::getline(in, rest)) << "text after the last frame";
    return clip;
}

std::vector<int> all_actions() {
    std::vector<int> out;
    for (int a = 1; a <= ntu::actions; ++a) out.push_back(a);
    return out;
}

NtuCasting casting(int action, int performer, int replication = 1, std::uint64_t seed = 3) {
    return {seed, 1 + performer % 32, performer, replication, action};
}

std::string slurp(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SynthNtu, SameBytesForAnyNumberOfThreads) {
    test::TempDir one, many;
    NtuOptions options{one.path(), 48, 5, {1, 27, 50, 114}, 1};
    EXPECT_EQ(synthesise_ntu(options).written, 48u);
    options.folder = many.path();
    options.threads = 5;
    std::uint64_t told = 0;
    synthesise_ntu(options, [&](std::uint64_t done) { EXPECT_EQ(done, ++told); });
    EXPECT_EQ(told, 48u);
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(one.path())) {
        EXPECT_EQ(slurp(entry.path()), slurp(many.path() / entry.path().filename()));
        files += entry.path().extension() == ".skeleton";
    }
    EXPECT_EQ(files, 48u);
}

TEST(SynthNtu, AnInterruptedRunIsCompletedAndAnotherSeedRefused) {
    test::TempDir folder;
    NtuOptions options{folder.path(), 6, 5, {8, 9}, 1};
    synthesise_ntu(options);
    const auto name = clip_at(2, {8, 9}).name() + ".skeleton";
    const auto bytes = slurp(folder.path() / name);
    fs::remove(folder.path() / name);
    options.clips = 8;  // a set can grow
    EXPECT_EQ(synthesise_ntu(options).written, 3u);
    EXPECT_EQ(slurp(folder.path() / name), bytes);
    options.seed = 6;
    EXPECT_THROW(synthesise_ntu(options), Error);
}

TEST(SynthNtu, RefusesWhatCannotBe) {
    test::TempDir folder;
    EXPECT_THROW(synthesise_ntu({folder.path(), 20353, 1, {4}, 1}), Error);
    EXPECT_THROW(synthesise_ntu({folder.path(), 1, 1, {121}, 1}), Error);
    std::ofstream(folder.path() / "file") << "x";
    EXPECT_THROW(synthesise_ntu({folder.path() / "file", 1, 1, {4}, 1}), Error);
}

TEST(SynthNtu, WellFormedWithUnitQuaternionsAndPlausiblePixels) {
    for (const int action : {2, 26, 43, 55, 60, 101, 116}) {
        const auto clip = parse(skeleton_text({7, 1 + action % 3, 12, 1, action}, 3));
        EXPECT_GE(clip.size(), 40u);
        EXPECT_LE(clip.size(), 180u);
        for (const auto& frame : clip)
            for (const auto& body : frame) {
                EXPECT_EQ(body.id / 1000000u, 72057594037u);
                for (int j = 0; j < joints; ++j) {
                    const auto& n = body.joint[j].number;
                    for (const double v : n) EXPECT_TRUE(std::isfinite(v));
                    EXPECT_GT(n[2], 0.8);
                    EXPECT_LT(n[2], 6.5);
                    EXPECT_NEAR(n[3], 256 + 366.5 * n[0] / n[2], 2);
                    EXPECT_NEAR(n[6], 567 - 1056.5 * n[1] / n[2], 2);
                    const double norm = std::sqrt(n[7] * n[7] + n[8] * n[8] + n[9] * n[9] + n[10] * n[10]);
                    const bool leaf = j == head || j == left_foot || j == right_foot || j >= left_tip;
                    EXPECT_NEAR(norm, leaf ? 0 : 1, 1e-5);
                    EXPECT_TRUE(body.joint[j].tracking >= 0 && body.joint[j].tracking <= 2);
                }
            }
    }
}

TEST(SynthNtu, NumbersReadBackToSevenDigits) {
    Random random{1};
    for (int i = 0; i < 20000; ++i) {
        const double v = (random.uniform() - 0.5) * std::pow(10.0, random.uniform(-4, 4));
        std::string text;
        append_number(text, v);
        EXPECT_NEAR(std::stod(text), v, std::abs(v) * 5.1e-7 + 1e-7) << text;
        EXPECT_LE(text.size(), 16u);
    }
    for (const auto& [value, text] : std::map<double, std::string>{
             {0, "0"}, {-0.5, "-0.5"}, {2, "2"}, {1919.99999, "1920"}, {0.9999999999, "1"}}) {
        std::string out;
        append_number(out, value);
        EXPECT_EQ(out, text);
    }
}

TEST(SynthNtu, BonesKeepTheirLengthAndBelongToThePerformer) {
    const auto& parents = ntu25().parents;
    for (int action = 1; action <= ntu::actions; ++action) {
        const auto p = perform(casting(action, 1 + action % 106));
        ASSERT_FALSE(p.frames.empty()) << action;
        for (int person = 0; person < p.persons; ++person)
            for (int j = 1; j < joints; ++j) {
                double least = 9, most = 0;
                for (const auto& frame : p.frames) {
                    const double l = length(frame[person][j] - frame[person][parents[j]]);
                    least = std::min(least, l);
                    most = test::larger(most, l);
                }
                EXPECT_LT(most - least, 1e-6) << "action " << action << " joint " << j;
            }
    }
    const auto thigh = [](int action, int performer) {
        const auto f = perform(casting(action, performer)).frames[0][0];
        return length(f[left_knee] - f[left_hip]);
    };
    EXPECT_NEAR(thigh(1, 20), thigh(27, 20), 1e-9);
    EXPECT_GT(std::abs(thigh(1, 20) - thigh(1, 21)), 1e-4);
}

double inner_angle(const Vec& a, const Vec& b, const Vec& c) {
    return std::acos(std::clamp(dot(normalised(a - b), normalised(c - b)), -1.0, 1.0)) * 180 / pi;
}

TEST(SynthNtu, KneesAndElbowsBendAsTheyCan) {
    for (int action = 1; action <= ntu::actions; ++action) {
        const auto p = perform(casting(action, 1 + (7 * action) % 106));
        for (const auto& frame : p.frames)
            for (int person = 0; person < p.persons; ++person) {
                const auto& j = frame[person];
                const Vec forward =
                    cross(normalised(j[left_hip] - j[right_hip]), normalised(j[spine] - j[pelvis]));
                for (const auto& [hip, knee, ankle] : {std::array{left_hip, left_knee, left_ankle},
                                                       std::array{right_hip, right_knee, right_ankle}}) {
                    EXPECT_GT(inner_angle(j[hip], j[knee], j[ankle]), 30) << action;
                    // Never backwards: the knee is not behind the line from hip to ankle.
                    const Vec axis = normalised(j[ankle] - j[hip]);
                    const Vec bulge = reject(j[knee] - j[hip], axis);
                    if (length(bulge) > 0.06) {
                        EXPECT_GT(dot(normalised(bulge), forward), -0.35) << "action " << action;
                    }
                }
                EXPECT_GT(inner_angle(j[left_shoulder], j[left_elbow], j[left_wrist]), 20) << action;
                EXPECT_GT(inner_angle(j[right_shoulder], j[right_elbow], j[right_wrist]), 20) << action;
            }
    }
}

TEST(SynthNtu, FeetStayOnTheFloorAndNothingJumpsFromFrameToFrame) {
    for (int action = 1; action <= ntu::actions; ++action) {
        const auto p = perform(casting(action, 1 + (3 * action) % 106));
        for (std::size_t f = 0; f < p.frames.size(); ++f)
            for (int person = 0; person < p.persons; ++person) {
                const auto& j = p.frames[f][person];
                for (int k = 0; k < joints; ++k) {
                    EXPECT_GT(j[k].y, -0.08) << "action " << action << " joint " << k;
                    if (f > 0) {
                        EXPECT_LT(length(j[k] - p.frames[f - 1][person][k]), 0.42)
                            << "action " << action << " joint " << k;
                    }
                }
            }
    }
}

TEST(SynthNtu, TwoPersonsTouchWhereAndWhenTheyShould) {
    const std::map<int, std::pair<std::vector<Joint>, std::vector<Joint>>> touching = {
        {50, {{left_hand, right_hand}, {head}}},
        {51, {{left_foot, right_foot}, {spine, pelvis, left_hip, right_hip, left_knee, right_knee}}},
        {52, {{left_hand, right_hand}, {chest, spine, left_shoulder, right_shoulder}}},
        {53, {{left_hand, right_hand}, {chest, spine}}},
        {55, {{left_hand, right_hand}, {chest, spine}}},
        {56, {{left_hand, right_hand}, {left_hand, right_hand}}},
        {57, {{left_hand, right_hand}, {left_hip, right_hip}}},
        {58, {{left_hand, right_hand}, {left_hand, right_hand}}},
        {111, {{left_foot, right_foot}, {left_foot, right_foot}}},
        {112, {{left_hand, right_hand}, {left_hand, right_hand}}},
        {118, {{left_hand, right_hand}, {left_hand, right_hand}}},
        {119, {{left_hand, right_hand}, {chest, spine}}}};
    for (const auto& [action, sides] : touching)
        for (int performer = 1; performer <= 106; performer += 7) {
            const auto p = perform(casting(action, performer));
            ASSERT_GE(p.contact, 0) << action;
            double nearest = 9;
            for (const int f : {p.contact - 1, p.contact, p.contact + 1})
                for (const auto mine : sides.first)
                    for (const auto theirs : sides.second)
                        nearest = std::min(nearest, length(p.frames[static_cast<std::size_t>(f)][0][mine] -
                                                           p.frames[static_cast<std::size_t>(f)][1][theirs]));
            EXPECT_LT(nearest, action == 51                    ? 0.32
                               : action == 57 || action == 119 ? 0.24
                                                               : 0.20)
                << "action " << action << " performer " << performer;
        }
}

TEST(SynthNtu, CamerasShowTheSamePerformance) {
    const NtuCasting c = casting(7, 40);
    const auto p = perform(c);
    const auto left = viewed(p, c.setup, 1), middle = viewed(p, c.setup, 2);
    const auto spread = [](const Joints& a, const Joints& b) {
        double most = 0;
        for (int i = 0; i < joints; ++i)
            for (int j = 0; j < joints; ++j)
                most = test::larger(most, std::abs(length(a[i] - a[j]) - length(b[i] - b[j])));
        return most;
    };
    EXPECT_LT(spread(left[20][0], middle[20][0]), 1e-9);
    EXPECT_GT(length(left[20][0][left_hand] - middle[20][0][left_hand]), 0.05);
    // Facing the camera, the left shoulder is at smaller x, as in the original.
    int facing = 0;
    for (int performer = 1; performer <= 40; ++performer) {
        const auto v = viewed(perform(casting(1, performer)), 1, 2);
        facing += v[0][0][left_shoulder].x < v[0][0][right_shoulder].x;
        for (const auto& frame : v) EXPECT_TRUE(frame[0][pelvis].z > 2 && frame[0][pelvis].z < 4.4);
    }
    EXPECT_GE(facing, 38);
}

TEST(SynthNtu, PeopleWhoStandAreUpright) {
    for (int setup = 1; setup <= 32; ++setup)
        for (int camera = 1; camera <= 3; ++camera) {
            const auto first = viewed(perform(casting(10, setup)), setup, camera)[0][0];
            const Vec up = normalised(first[chest] - first[pelvis]);
            // The camera's tilt of up to 4 degrees and the bearing's of some more.
            EXPECT_LT(std::acos(up.y) * 180 / pi, 12) << "setup " << setup << " camera " << camera;
        }
}

TEST(SynthNtu, NamesAreUniqueAndFillEverySplit) {
    const auto actions = all_actions();
    for (const std::uint64_t n : {200u, 240u, 480u}) {
        std::set<std::string> names;
        std::map<std::string, int> sides;
        std::map<int, int> classes;
        for (std::uint64_t i = 0; i < n; ++i) {
            const auto id = clip_at(i, actions);
            names.insert(id.name());
            ++sides[ntu::xsub_train(id.performer) ? "xsub/train" : "xsub/test"];
            ++sides[id.setup % 2 == 0 ? "xset/train" : "xset/test"];
            if (id.action <= 60) ++sides[id.camera == 1 ? "xview/test" : "xview/train"];
            ++classes[id.action];
        }
        EXPECT_EQ(names.size(), n);
        for (const auto& side : {"xsub/train", "xsub/test", "xset/train", "xset/test"})
            EXPECT_GT(sides[side], n * 2 / 5) << side;
        EXPECT_GT(sides["xview/test"], n / 8);
        EXPECT_GT(sides["xview/train"], n / 4);
        for (const auto& [action, clips] : classes) EXPECT_LE(clips, static_cast<int>((n + 119) / 120));
    }
    std::set<std::string> every;  // all there are of one action
    for (std::uint64_t i = 0; i < clips_per_action; ++i) every.insert(clip_at(i, {17}).name());
    EXPECT_EQ(every.size(), clips_per_action);
}

TEST(SynthNtu, TheKinectErrsAsOftenAsPlanned) {
    int clips = 0, gaps = 0, ghosts = 0, pairs = 0, swaps = 0;
    std::map<Tracking, double> tracking;
    for (int i = 0; i < 480; ++i) {
        const auto id = clip_at(static_cast<std::uint64_t>(i), all_actions());
        const NtuCasting c{11, id.setup, id.performer, id.replication, id.action};
        const auto p = perform(c);
        const auto recording = record(p, c, id.camera);
        bool gap = false, ghost = false, swap = false;
        std::vector<std::uint64_t> order;
        for (const auto& frame : recording) {
            gap |= static_cast<int>(frame.size()) < p.persons;
            std::vector<std::uint64_t> ids;
            for (const auto& body : frame) {
                ghost |=
                    body.id % 10000 != frame.front().id % 10000 && static_cast<int>(frame.size()) > p.persons;
                ids.push_back(body.id);
                for (const auto& joint : body.joint) ++tracking[joint.tracking];
            }
            if (static_cast<int>(ids.size()) == 2 && p.persons == 2) {
                swap |= !order.empty() && order == std::vector{ids[1], ids[0]};
                order = ids;
            }
        }
        ++clips;
        gaps += gap;
        ghosts += ghost;
        pairs += p.persons == 2;
        swaps += swap;
    }
    const auto share = [&](Tracking t) {
        return tracking[t] /
               (tracking[Tracking::lost] + tracking[Tracking::inferred] + tracking[Tracking::tracked]);
    };
    RecordProperty("inferred", std::to_string(share(Tracking::inferred)));
    EXPECT_NEAR(gaps / double(clips), 0.28, 0.12);
    EXPECT_NEAR(ghosts / double(clips), 0.07, 0.045);
    EXPECT_NEAR(swaps / double(pairs), 0.30, 0.15);
    EXPECT_GT(share(Tracking::inferred), 0.03);
    EXPECT_LT(share(Tracking::inferred), 0.30);
    EXPECT_GT(share(Tracking::lost), 0.001);
    EXPECT_GT(share(Tracking::tracked), 0.68);
}

/// Positions against the first person's pelvis, turned to face ahead, 32 moments; `mirror` exchanges the
/// sides.
std::vector<float> features(const Performance& p, bool mirror) {
    static constexpr std::array twin = {0,  1,  2,  3,  8,  9,  10, 11, 4,  5,  6,  7, 16,
                                        17, 18, 19, 12, 13, 14, 15, 20, 23, 24, 21, 22};
    const auto& first = p.frames[0][0];
    const Vec across =
        normalised({first[left_hip].x - first[right_hip].x, 0, first[left_hip].z - first[right_hip].z});
    const Rotation ahead{across, {0, 1, 0}, cross(across, {0, 1, 0})};
    std::vector<float> out;
    for (std::size_t t = 0; t < 32; ++t) {
        const auto& frame = p.frames[t * (p.frames.size() - 1) / 31];
        for (int person = 0; person < p.persons; ++person)
            for (int j = 0; j < joints; ++j) {
                Vec v =
                    ahead.into(frame[person][mirror ? twin[static_cast<std::size_t>(j)] : j] - first[pelvis]);
                if (mirror) v.x = -v.x;
                for (const double c : {v.x, v.y, v.z}) out.push_back(static_cast<float>(c));
            }
    }
    return out;
}

float distance(const std::vector<float>& a, const std::vector<float>& b) {
    float sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

/// The mean of clips by `performers`, each mirrored where that brings it nearer to the first.
std::vector<float> centroid(int action, const std::vector<int>& performers) {
    std::vector<float> first, sum;
    for (const int performer : performers) {
        const auto p = perform(casting(action, performer));
        auto as_is = features(p, false), other = features(p, true);
        if (first.empty()) first = as_is, sum.assign(as_is.size(), 0);
        const auto& nearer = distance(as_is, first) <= distance(other, first) ? as_is : other;
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += nearer[i] / static_cast<float>(performers.size());
    }
    return sum;
}

TEST(SynthNtu, ActionsAreRecognisedOnOtherPerformers) {
    std::vector<std::vector<float>> centroids(ntu::actions + 1);
    for (int a = 1; a <= ntu::actions; ++a) centroids[a] = centroid(a, {1, 4, 8, 15, 16, 25, 31, 45});
    int right = 0, all = 0;
    std::map<std::string, int> mistakes;
    for (int a = 1; a <= ntu::actions; ++a)
        for (const int performer : {3, 6, 7, 10}) {
            const auto p = perform(casting(a, performer));
            const auto as_is = features(p, false), other = features(p, true);
            int best = 0;
            float least = 1e30f;
            for (int c = 1; c <= ntu::actions; ++c) {
                if (ntu::two_persons(c) != ntu::two_persons(a)) continue;
                const float d = std::min(distance(as_is, centroids[c]), distance(other, centroids[c]));
                if (d < least) least = d, best = c;
            }
            right += best == a;
            ++all;
            if (best != a)
                ++mistakes[fmt::format("{} taken for {}", ntu::action_name(a), ntu::action_name(best))];
        }
    std::string text;
    for (const auto& [mistake, n] : mistakes) text += fmt::format("{} x {}\n", n, mistake);
    fmt::print("nearest centroid: {:.1f} %\n", 100.0 * right / all);
    EXPECT_GT(right / double(all), 0.85) << text;
}

}  // namespace
}  // namespace actformer::ingest::synth
