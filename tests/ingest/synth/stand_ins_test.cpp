// Stand-ins as their readers meet them: layouts, sizes, and the same bytes for any number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/numpy/npz.hpp"
#include "base/pickle/pickle.hpp"
#include "ingest/dataset/height.hpp"
#include "ingest/dataset/origin.hpp"
#include "ingest/formats/formats.hpp"
#include "ingest/pipeline/pipeline.hpp"
#include "ingest/synth/babel/acts.hpp"
#include "ingest/synth/babel/plan.hpp"
#include "ingest/synth/gta/gta.hpp"
#include "ingest/synth/ntu/ntu.hpp"
#include "ingest/synth/performer/play.hpp"
#include "ingest/synth/pickle_writer.hpp"
#include "ingest/synth/programmes/exercises.hpp"
#include "ingest/synth/programmes/fights.hpp"
#include "ingest/synth/rotation_vector.hpp"
#include "ingest/synth/smpl/smpl_motion.hpp"
#include "ingest/synth/stand_in.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::ingest::synth {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> files_in(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            files[entry.path().lexically_relative(folder).string()] = test::read_file(entry.path());
    return files;
}

const StandIn& stand_in(std::string_view name) {
    for (const auto& one : stand_ins())
        if (one.name == name) return one;
    throw std::out_of_range(std::string(name));
}

struct StandIns : testing::Test {
    std::map<std::string, std::string> made(std::string_view name, std::uint64_t clips, unsigned threads = 2,
                                            std::uint64_t seed = 1) {
        const auto folder = dir / fs::path(fmt::format("{}-{}-{}-{}", name, clips, threads, seed));
        summary = stand_in(name).make({folder, clips, seed, threads, {}});
        return files_in(folder);
    }
    test::TempDir dir;
    StandInSummary summary;
};

std::vector<double> numbers(const PickleValue& value) {
    return value.array().all_numbers();
}

TEST(PickleWriter, WritesWhatTheReaderReads) {
    PickleWriter p;
    const std::vector<double> a{1.5, -2, 1e300};
    const std::vector<float> b{1, 2, 3, 4};
    const std::vector<std::int64_t> c{-7};
    p.dict([&] {
        p.text("a");
        p.array({3, 1}, a);
        p.text("b");
        p.array({2, 2}, b);
        p.integer(1);
        p.list([&] {
            p.array({1}, c);
            p.integer(-3);
            p.number(0.1);
            p.none();
            p.list([] {});
        });
    });
    const auto bytes = p.finish();
    const Pickle pickle(bytes);
    const auto root = pickle.root();
    EXPECT_EQ(numbers(root.get("a")), a);
    EXPECT_EQ(root.get("a").array().shape, (std::vector<std::uint64_t>{3, 1}));
    EXPECT_EQ(numbers(root.get("b")), (std::vector<double>{1, 2, 3, 4}));
    const auto list = root.find(std::int64_t{1}).value();
    ASSERT_EQ(list.size(), 5U);
    EXPECT_EQ(numbers(list[0]), std::vector<double>{-7});
    EXPECT_EQ(list[1].whole(), -3);
    EXPECT_EQ(list[2].real(), 0.1);
    EXPECT_TRUE(list[3].is_none());
    EXPECT_EQ(list[4].size(), 0U);
}

TEST_F(StandIns, AreTheSameForAnyNumberOfThreadsAndNotForAnotherSeed) {
    for (const auto& one : stand_ins()) {
        const auto files = made(one.name, 6, 1);
        EXPECT_EQ(files, made(one.name, 6, 3)) << one.name;
        EXPECT_EQ(summary.clips, 6U) << one.name;
        EXPECT_GT(summary.frames, 6 * 40U) << one.name;
        EXPECT_NE(files, made(one.name, 6, 1, 2)) << one.name;
        EXPECT_THROW(one.make({dir / fs::path(fmt::format("{}-6-1-1", one.name)), 6, 3, 1, {}}), Error)
            << "another seed's clips are there";
        EXPECT_NO_THROW(one.make({dir / fs::path(fmt::format("{}-6-1-1", one.name)), 6, 1, 1, {}}))
            << "made again";
    }
}

TEST_F(StandIns, AreNotMadeAmongFilesOfOthers) {
    const auto expect_refused = [&](const std::string& name, const std::string& file, const auto& make) {
        const fs::path folder = dir / fs::path(name + "-" + file.substr(0, 4));
        test::write_file(folder / file, "precious");
        const auto why = test::error_of([&] { make(folder); });
        EXPECT_NE(why.find(file), std::string::npos) << name << ": " << why;
        EXPECT_NE(why.find("choose another -o"), std::string::npos) << name << ": " << why;
        EXPECT_EQ(files_in(folder), (std::map<std::string, std::string>{{file, "precious"}})) << name;
    };
    for (const auto* file : {"babel_v1.0_release/train.json", "info/names.txt", "ORIGIN"}) {
        for (const auto& one : stand_ins())
            expect_refused(std::string(one.name), file, [&](const auto& folder) {
                one.make({folder, 2, 1, 1, {}});
            });
        expect_refused("ntu", file, [](const auto& folder) { synthesise_ntu({folder, 2, 1, {8}, 1}); });
    }
    fs::create_directories(dir / "links");
    fs::create_directory_symlink("../babel-babe/babel_v1.0_release", dir / "links/babel_v1.0_release");
    const auto why = test::error_of([&] { stand_in("babel").make({dir / "links", 2, 1, 1, {}}); });
    EXPECT_NE(why.find("links: holds files that no synth left, as babel_v1.0_release;"), std::string::npos)
        << why;
}

TEST_F(StandIns, GoOnAfterAnyStart) {
    const auto right = made("ntu13", 2);
    const std::vector<std::vector<const char*>> kept{
        {}, {"synth.json"}, {"ORIGIN"}, {"synth.json", "ORIGIN"}, {"synth.json.partial"}};
    for (const auto& files : kept) {
        const fs::path folder = dir / fs::path(fmt::format("killed {}", fmt::join(files, " ")));
        fs::create_directories(folder / "ntu_vibe");
        for (const auto* file : files)
            test::write_file(folder / file, right.contains(file) ? right.at(file) : "cut");
        stand_in("ntu13").make({folder, 2, 1, 1, {}});
        EXPECT_EQ(files_in(folder), right) << folder;
    }
}

TEST_F(StandIns, LeaveAnotherOrigin) {
    const auto right = made("ntu13", 2);
    const auto folder = dir / "ntu13-2-2-1";
    for (const std::string said : {"synthetic\n", "recorded by my camera\n", ""}) {
        test::write_file(folder / "ORIGIN", said);
        const auto why = test::error_of([&] { stand_in("ntu13").make({folder, 2, 1, 1, {}}); });
        EXPECT_NE(why.find("ORIGIN: does not say stand-in"), std::string::npos) << why;
        EXPECT_EQ(test::read_file(folder / "ORIGIN"), said);
    }
    fs::remove(folder / "ORIGIN");
    EXPECT_EQ(made("ntu13", 2), right) << "where there is none it is written";
}

TEST_F(StandIns, SayThatTheyAreStandInsBeforeTheFirstClipIsDone) {
    const auto origin_at_first = [&](const std::string& name, const auto& make) {
        const auto folder = dir / fs::path(name);
        std::mutex mutex;
        std::optional<DataOrigin::Kind> told;
        bool any = false;
        make(folder, [&](std::uint64_t) {
            const std::lock_guard lock(mutex);
            if (!std::exchange(any, true)) told = read_origin(folder);
        });
        EXPECT_TRUE(any) << name;
        EXPECT_EQ(told, DataOrigin::Kind::stand_in) << name;
    };
    for (const auto& one : stand_ins())
        origin_at_first(std::string(one.name), [&](const auto& folder, const auto& progress) {
            one.make({folder, 2, 1, 2, progress});
        });
    origin_at_first("ntu", [](const auto& folder, const auto& progress) {
        NtuOptions options;
        options.folder = folder;
        options.clips = 2;
        synthesise_ntu(options, progress);
    });
}

TEST_F(StandIns, MoreClipsInAFolderAreThoseOfAnEmptyOneOrRefused) {
    for (const auto& one : stand_ins()) {
        const auto folder = dir / fs::path(one.name);
        one.make({folder, 6, 1, 2, {}});
        try {
            one.make({folder, 9, 1, 2, {}});
        } catch (const Error& e) {
            EXPECT_EQ(one.name, "babel") << e.what();
            EXPECT_NE(std::string(e.what()).find("9 clips"), std::string::npos) << e.what();
            continue;
        }
        EXPECT_NE(one.name, "babel") << "which actions its recordings hold depends on how many there are";
        EXPECT_EQ(files_in(folder), made(one.name, 9)) << one.name;
    }
}

/// Which way the pelvis faces in the first frame, degrees about y from z.
double facing(const Motion& motion) {
    // First two rows of the root's rotation, row-major: x and z of its third column are r02, and r22 by the cross product.
    const float* r = motion.values.data();
    const double r22 = double{r[0]} * r[4] - double{r[1]} * r[3];
    return std::atan2(double{r[2]}, r22) * 180 / pi;
}

/// Of every joint's rotation vector over the frames of a data set of rotations, degrees: the smallest of its three components.
std::vector<double> turning(const Dataset& dataset) {
    std::array<std::array<double, 3>, smpl_joints> sum{}, squares{};
    double frames = 0;
    for (std::size_t i = 0; i < dataset.clips().size(); ++i) {
        const auto motion = dataset.motion(i);
        const std::size_t numbers = 6 * (smpl_joints + 1);
        for (std::size_t at = 0; at + numbers <= motion.values.size(); at += numbers, ++frames)
            for (std::size_t j = 0; j < smpl_joints; ++j) {
                const float* r = &motion.values[at + 6 * j];
                const Vec a{r[0], r[1], r[2]}, b{r[3], r[4], r[5]};
                const auto v = rotation_vector(inverse({a, b, cross(a, b)}));
                const std::array<double, 3> degrees{v.x * 180 / pi, v.y * 180 / pi, v.z * 180 / pi};
                for (std::size_t d = 0; d < 3; ++d) {
                    sum[j][d] += degrees[d];
                    squares[j][d] += degrees[d] * degrees[d];
                }
            }
    }
    std::vector<double> out;
    for (std::size_t j = 0; j < smpl_joints; ++j) {
        double least = 360;
        for (std::size_t d = 0; d < 3; ++d)
            least = std::min(least, std::sqrt(squares[j][d] / frames - std::pow(sum[j][d] / frames, 2)));
        out.push_back(least);
    }
    return out;
}

TEST_F(StandIns, ComeThroughTheirIngestUprightFacingTheCameraAndAliveInEveryJoint) {
    kernels::Device device;
    for (const auto& one : stand_ins()) {
        made(one.name, 160);
        const auto entry = std::find_if(formats().begin(), formats().end(),
                                        [&](const auto& e) { return e.name == one.name; });
        ASSERT_NE(entry, formats().end()) << one.name;
        const auto command = entry->command();
        const auto format = command->open(std::string(one.name));
        IngestRequest request;
        request.raw = {dir / fs::path(fmt::format("{}-160-2-1", one.name))};
        request.out = dir / fs::path("in-" + std::string(one.name));
        request.one_dataset = command->one_dataset();
        const auto taken = actformer::ingest::ingest(request, *format, device);
        EXPECT_FALSE(taken.left_out.contains("broken"))
            << one.name << ": " << fmt::format("{}", fmt::join(taken.first_rejections, "; "));
        std::uint64_t clips = 0;
        for (const auto& folder : datasets_at(request.out)) {
            const Dataset dataset(folder);
            clips += dataset.clips().size();
            const auto height = body_height(dataset);
            EXPECT_EQ(height->axis, 'y') << folder;
            EXPECT_NEAR(height->metres, 1.5, 0.2) << folder;
            if (dataset.header().representation != Representation::rot6d) continue;
            const auto turns = turning(dataset);
            const std::size_t turning_joints =
                one.name == "babel" ? 22 : 24;  // SMPL+H's files are without hands
            for (std::size_t j = 0; j < turning_joints; ++j)
                EXPECT_GT(turns[j], 1.5) << one.name << " joint " << j;
            if (one.name == "babel") continue;
            for (std::size_t i = 0; i < dataset.clips().size(); ++i)
                EXPECT_LT(std::abs(facing(dataset.motion(i))), 150)
                    << one.name << " " << dataset.clips()[i].name;
        }
        EXPECT_GE(clips, 140U) << one.name;
    }
}

TEST_F(StandIns, HumanAct12HasRotationsThatGiveItsJoints) {
    const auto files = made("humanact12", 24);
    const auto& text = files.at("HumanAct12Poses/humanact12poses.pkl");
    const Pickle pickle(text);
    const auto root = pickle.root();
    ASSERT_EQ(root.get("poses").size(), 24U);
    EXPECT_EQ(root.get("oldposes").size(), 0U);
    for (std::size_t i = 0; i < 24; ++i) {
        EXPECT_EQ(root.get("y")[i].whole(), static_cast<std::int64_t>(i % 12));
        const auto poses = numbers(root.get("poses")[i]), joints = numbers(root.get("joints3D")[i]);
        const auto frames = poses.size() / 72;
        ASSERT_EQ(joints.size(), frames * 72);
        for (std::size_t f = 0; f < frames; f += 20) {
            SmplPose pose;
            pose.pelvis = {joints[f * 72], joints[f * 72 + 1], joints[f * 72 + 2]};
            for (std::size_t j = 0; j < smpl_joints; ++j) {
                const double* v = &poses[f * 72 + 3 * j];
                const double angle = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
                const Vec axis = angle > 0 ? Vec{v[0], v[1], v[2]} * (1 / angle) : Vec{1, 0, 0};
                const auto turn = [&](const Vec& u) { return turned(u, axis, angle * 180 / pi); };
                pose.turned[j] = {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})};
            }
            const auto at = smpl_places(pose);
            for (std::size_t j = 0; j < smpl_joints; ++j)
                EXPECT_LT(length(at[j] - Vec{joints[f * 72 + 3 * j], joints[f * 72 + 3 * j + 1],
                                             joints[f * 72 + 3 * j + 2]}),
                          1e-9);
            EXPECT_LT(at[15].y, at[10].y) << "y is down: the head is above the feet";
            EXPECT_GT(at[0].z, 1) << "before the camera";
        }
    }
}

TEST_F(StandIns, NtuReconHasUnitsOfItsOwnAndYDown) {
    const auto files = made("nturecon", 20);
    std::size_t pickles = 0;
    for (const auto& [name, text] : files) {
        if (!name.ends_with("_body0.pkl")) continue;
        ++pickles;
        EXPECT_EQ(name.substr(0, 13), "motions/" + fs::path(name).filename().string().substr(0, 4) + "/");
        const Pickle pickle(text);
        const auto root = pickle.root();
        const auto frames = root.get("smpl_poses").array().shape.at(0);
        EXPECT_EQ(root.get("smpl_trans").array().shape, (std::vector<std::uint64_t>{frames, 3}));
        const auto scaling = numbers(root.get("smpl_scaling")).at(0);
        EXPECT_NEAR(numbers(root.get("smpl_trans")).at(2) / scaling, 3, 1.5) << "metres before the camera";
    }
    EXPECT_EQ(pickles, 20U);
}

TEST_F(StandIns, BabelIsLongTailedAndEveryCategoryIsInBothFiles) {
    const auto counts = occurrences(1800, 120);
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}), 1800U);
    EXPECT_GT(counts[0], 50U);
    EXPECT_GE(counts[119], 8U);
    EXPECT_TRUE(std::is_sorted(counts.rbegin(), counts.rend()));
    std::array<std::set<std::size_t>, 2> seen;
    std::set<std::string> names;
    std::set<double> rates;
    for (const auto& one : plan(1800, 1)) {
        EXPECT_TRUE(names.insert(one.feat_p()).second) << one.feat_p();
        rates.insert(one.fps);
        seen[one.validation ? 1 : 0].insert(one.acts.begin(), one.acts.end());
    }
    EXPECT_EQ(seen[0].size(), 120U);
    EXPECT_EQ(seen[1].size(), 120U);
    EXPECT_EQ(rates, (std::set<double>{59.9999885559082, 60, 100, 120, 250}));
    std::set<std::string_view> categories;
    for (const auto& act : acts()) categories.insert(act.category);
    EXPECT_EQ(categories.size(), 120U);
    EXPECT_LE(plan(1, 1).size(), 1U);
}

TEST_F(StandIns, BabelsLabelsFitItsRecordings) {
    const auto files = made("babel", 60);
    std::size_t labelled = 0;
    bool overlaps = false;
    for (const auto file : {"babel_v1.0_release/train.json", "babel_v1.0_release/val.json"}) {
        const auto json = nlohmann::json::parse(files.at(file));
        for (const auto& [sid, one] : json.items()) {
            EXPECT_EQ(one["babel_sid"], std::stoul(sid));
            const auto path = one["feat_p"].get<std::string>();
            const auto& npz = files.at("amass" + path.substr(path.find('/')));
            double fps = 0, frames = 0;
            read_npz(npz, {}, [&](const std::string& name, const NumpyArray& array) {
                if (name == "mocap_framerate") fps = array.all_numbers()[0];
                if (name == "poses") {
                    EXPECT_EQ(array.shape[1], 156U);
                    frames = static_cast<double>(array.shape[0]);
                }
                if (name == "trans") {
                    EXPECT_GT(array.all_numbers()[2], 0.2) << "z is up, and the pelvis above the floor";
                }
            });
            EXPECT_NEAR(frames / fps, one["dur"].get<double>(), 1.5 / 30) << path;
            double end = 0;
            for (const auto& label :
                 one["frame_ann"].is_null() ? one["seq_ann"]["labels"] : one["frame_ann"]["labels"]) {
                ++labelled;
                if (!label.contains("start_t")) continue;
                EXPECT_LT(label["start_t"], label["end_t"]);
                overlaps |= label["start_t"].get<double>() < end;
                end = label["end_t"].get<double>();
            }
        }
    }
    EXPECT_GE(labelled, 60U);
    EXPECT_TRUE(overlaps);
}

TEST_F(StandIns, VibesTracksAreOfThePersonsWhoAct) {
    const auto files = made("ntu13", 13);
    std::istringstream list(files.at("ntu_vibe_list.txt"));
    std::size_t paths = 0;
    for (std::string path; std::getline(list, path); ++paths) {
        const auto& text = files.at(path);
        const Pickle pickle(text);
        const auto track = pickle.root().find(std::int64_t{1}).value();
        const auto frames = track.get("pose").array().shape.at(0);
        EXPECT_EQ(track.get("joints3d").array().shape, (std::vector<std::uint64_t>{frames, 49, 3}));
        const auto joints = numbers(track.get("joints3d"));
        EXPECT_LT(joints[1], joints[3 * 19 + 1] - 0.8) << "the nose is above the toes, y down";
        EXPECT_GT(joints[3 * 12], joints[3 * 9]) << "facing the camera, the left hip is to the right";
    }
    EXPECT_EQ(paths, 13U);
}

TEST_F(StandIns, UestcsListsAreAsLong) {
    const auto files = made("uestc", 80);
    const auto lines = [&](const char* file) {
        return std::count(files.at(file).begin(), files.at(file).end(), '\n');
    };
    EXPECT_EQ(lines("info/names.txt"), 80);
    EXPECT_EQ(lines("info/num_frames_min.txt"), 80);
    EXPECT_EQ(lines("info/action_classes.txt"), 40);
    const Pickle pickle(files.at("vibe_cache_refined.pkl"));
    for (const auto key : {"pred_cam", "orig_cam", "pose", "betas", "joints3d", "bboxes", "frame_ids"})
        EXPECT_EQ(pickle.root().get(key).size(), 80U) << key;
    std::istringstream lengths(files.at("info/num_frames_min.txt"));
    for (std::size_t i = 0; i < 80; ++i) {
        std::uint64_t frames = 0;
        lengths >> frames;
        EXPECT_EQ(pickle.root().get("pose")[i].array().shape.at(0), frames);
    }
}

TEST_F(StandIns, GtasLimbsAreUnitVectorsAboutTheGroupsMean) {
    const auto files = made("gta", 30);
    for (std::size_t persons = 2; persons <= 5; ++persons) {
        const hdf5::Reader file(dir / "gta-30-2-1" / fmt::format("gta_combat_{}p.h5", persons));
        const auto shape = file.shape("00000_A001");
        ASSERT_EQ(shape[0], 3 * persons);
        ASSERT_EQ(shape[1], gta_joints);
        EXPECT_GE(shape[2], 66U);
        const auto v = file.read<float>("00000_A001");
        std::array<double, 3> mean{};
        for (std::size_t c = 0; c < shape[0]; ++c)
            for (std::size_t t = 0; t < shape[2]; ++t) mean[c % 3] += v[c * gta_joints * shape[2] + t];
        for (const double m : mean) EXPECT_NEAR(m, 0, 1e-2);  // a sum of some hundred float32
        for (std::size_t p = 0; p < persons; ++p)
            for (std::size_t j = 1; j < gta_joints; ++j) {
                double square = 0;
                for (std::size_t d = 0; d < 3; ++d)
                    square += std::pow(v[((3 * p + d) * gta_joints + j) * shape[2]], 2);
                EXPECT_NEAR(std::sqrt(square), 1, 5e-3) << "divided by its length and 1e-4";
            }
    }
}

TEST(GtaClips, PeopleFightWithTheirFeetOnTheFloorAndNobodyWalksThroughAnother) {
    for (std::uint64_t number = 0; number < 12; ++number)
        for (std::size_t persons = 2; persons <= 5; ++persons) {
            const auto clip = gta_clip(persons, number, 3);
            ASSERT_EQ(clip.size(), persons);
            for (std::size_t t = 0; t < clip[0].size(); t += 3)
                for (std::size_t p = 0; p < persons; ++p) {
                    const auto& at = clip[p][t];
                    EXPECT_GT(std::min(at[18].y, at[21].y), 0.0);
                    EXPECT_LT(std::min(at[18].y, at[21].y), 0.2) << "one foot stands, or the person lies";
                    for (std::size_t j = 1; j < gta_joints; ++j)
                        EXPECT_NEAR(length(at[j] - at[static_cast<std::size_t>(gta22_parents[j])]),
                                    gta_lengths[j], 1e-9);
                    for (std::size_t q = p + 1; q < persons; ++q)
                        EXPECT_GT(std::hypot(at[0].x - clip[q][t][0].x, at[0].z - clip[q][t][0].z), 0.35)
                            << "persons " << p << " and " << q << " of " << number;
                }
        }
}

TEST(Fights, BlowsMeetBodies) {
    for (std::size_t i = 0; i < fights().size(); ++i)
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            const Casting casting{{seed, i}, {{gta_body(), 2 + seed}, {gta_body(), 40 + seed}}};
            const auto scene = play(fights()[i], casting);
            ASSERT_GE(scene.contact, 0) << i;
            double nearest = 9;
            for (int f = std::max(0, scene.contact - 3); f <= scene.contact + 3; ++f) {
                const auto& both = scene.frames[static_cast<std::size_t>(f)];
                for (const bool first : {true, false})  // either may strike
                    for (const auto mine : {left_hand, right_hand, left_foot, right_foot})
                        for (const auto theirs :
                             {head, neck, chest, spine, pelvis, left_hip, right_hip, left_knee, right_knee,
                              left_wrist, right_wrist, left_shoulder, right_shoulder})
                            nearest = std::min(nearest, length(both[first ? 0 : 1].at[mine] -
                                                               both[first ? 1 : 0].at[theirs]));
            }
            EXPECT_LT(nearest, 0.26) << "fight " << i << " seed "
                                     << seed;  // joints lie inside: heads, thighs and bellies are that thick
        }
}

}  // namespace
}  // namespace actformer::ingest::synth
