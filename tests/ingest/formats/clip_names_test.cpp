// Which clips files hold, by pattern, by labels and by both.
#include "ingest/formats/clip_names.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::ingest {
namespace {

using Names = std::vector<std::string>;

RawText raw(const std::string& path, const std::string& inside, std::uint64_t index = 0) {
    const auto name = std::string_view(path).substr(path.find_last_of("/:") + 1);
    return {path, name.substr(0, name.rfind('.')), {}, inside, index};
}

std::vector<NamedClip> clips(const ClipNames& names, const std::string& path, const std::string& inside) {
    auto found = names.clips_of(raw(path, inside));
    if (const auto* r = std::get_if<Rejection>(&found)) {
        ADD_FAILURE() << r->reason;
        return {};
    }
    return std::get<std::vector<NamedClip>>(std::move(found));
}

TEST(ClipNames, AreTheFilesWhereTheseDiffer) {
    ClipNames names("{action}_{index}", "");
    const std::string a = "/d/x/walk_1.bvh", b = "/d/y/run_1.bvh";
    names.note(raw(a, "x/walk_1.bvh"));
    names.note(raw(b, "y/run_1.bvh", 1));
    names.settle();
    const auto found = clips(names, a, "x/walk_1.bvh");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].name, "walk_1");
    EXPECT_EQ(found[0].action, "walk");
    EXPECT_EQ(found[0].fields, (Names{"walk", "1"}));
    EXPECT_EQ(names.fields(), (Names{"action", "index"}));
}

TEST(ClipNames, NeedAPatternOrLabels) {
    try {
        ClipNames("", "");
        ADD_FAILURE() << "taken";
    } catch (const Error& e) {
        EXPECT_STREQ(
            e.what(),
            "no actions are told; give --name, as in --name '{action}_{index}' or '{action}/{index}', "
            "or a table of labels with --labels");
    }
}

TEST(ClipNames, HaveAsManyFoldersAsTellThemApart) {
    ClipNames names("{action}/{index}", "");
    const Names paths{"/d/walk/1.bvh", "/d/walk/2.bvh", "/d/run/1.bvh", "/d/run/2.bvh"};
    for (std::size_t i = 0; i < paths.size(); ++i) names.note(raw(paths[i], paths[i].substr(3), i));
    names.settle();
    EXPECT_EQ(clips(names, paths[0], "walk/1.bvh")[0].name, "walk_1");
    EXPECT_EQ(clips(names, paths[3], "run/2.bvh")[0].name, "run_2");
    // A folder that was given itself is known too.
    EXPECT_EQ(clips(names, "/d/walk/1.bvh", "1.bvh")[0].action, "walk");
    // In an archive paths begin at its top.
    EXPECT_EQ(clips(names, "a.zip:sit/1.bvh", "sit/1.bvh")[0].action, "sit");
    const auto above = names.clips_of(raw("sit/a.zip:1.bvh", "1.bvh"));
    EXPECT_EQ(std::get<Rejection>(above).reason, "the name does not fit the pattern '{action}/{index}'");
}

TEST(ClipNames, LabelsCutFilesIntoClips) {
    const test::TempDir dir;
    const auto table = dir / "labels.csv";
    test::write_file(table,
                     "file,action,subject,start,end\nx/a.bvh,walk,s1,0,10\nx/"
                     "a.bvh,run,s1,10,\nb.bvh,sit,s2,,\nc.bvh,sit,s2,,\n");
    ClipNames names("{*}/{take}", table);
    EXPECT_EQ(names.fields(), (Names{"action", "subject", "take"}));
    names.note(raw("/d/x/a.bvh", "x/a.bvh"));
    names.note(raw("/d/x/b.bvh", "x/b.bvh", 1));
    names.note(raw("/d/x/z.bvh", "x/z.bvh", 2));
    names.settle();
    const auto found = clips(names, "/d/x/a.bvh", "x/a.bvh");
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].name, "a_0-10");
    EXPECT_EQ(found[1].name, "a_10-end");
    EXPECT_EQ(found[1].action, "run");
    EXPECT_EQ(found[1].start, 10U);
    EXPECT_EQ(found[1].end, std::nullopt);
    EXPECT_EQ(found[1].fields, (Names{"run", "s1", "a"}));
    EXPECT_EQ(clips(names, "/d/x/b.bvh", "x/b.bvh")[0].name, "b");
    const auto without = names.clips_of(raw("/d/x/z.bvh", "x/z.bvh"));
    EXPECT_EQ(std::get<Rejection>(without).kind, Rejection::Kind::dropped);
    EXPECT_EQ(names.unused_labels(),
              table.string() + ": 1 of 4 rows are for files that are not there: c.bvh");
}

TEST(ClipNames, LabelsOfOneSpanHaveTheirActionsInTheirNames) {
    const test::TempDir dir;
    test::write_file(dir / "labels.csv",
                     "file,action,start,end\na,walk,0,10\na,wave,0,10\na,sit,10,20\na,sit,10,20\n");
    const ClipNames names("", dir / "labels.csv");
    Names found;
    for (const auto& clip : clips(names, "a.bvh", "a.bvh")) found.push_back(clip.name);
    EXPECT_EQ(found, (Names{"a_0-10_walk", "a_0-10_wave", "a_10-20", "a_10-20"}))
        << "a row that comes twice is one";
}

TEST(ClipNames, FilesOfOneClipShareAllFieldsButThePerson) {
    ClipNames names("{action}_{take}_{person}", "");
    EXPECT_EQ(names.fields(), (Names{"action", "take"}));
    const auto group = [&](const char* path) { return names.group_of(raw(path, path)); };
    EXPECT_EQ(group("hug_1_a.bvh"), group("hug_1_b.bvh"));
    EXPECT_NE(group("hug_1_a.bvh"), group("hug_2_a.bvh"));
    EXPECT_EQ(group("hug.bvh"), "");
    EXPECT_EQ(ClipNames("{action}_{take}", "").group_of(raw("hug_1.bvh", "hug_1.bvh")), "");

    const test::TempDir dir;
    test::write_file(dir / "labels.csv",
                     "file,action,take,person\na.bvh,hug,1,left\nb.bvh,hug,1,right\nc.bvh,hug,2,left\n");
    const ClipNames labelled("", dir / "labels.csv");
    EXPECT_EQ(labelled.fields(), (Names{"action", "take"}));
    EXPECT_EQ(labelled.group_of(raw("a.bvh", "a.bvh")), labelled.group_of(raw("b.bvh", "b.bvh")));
    EXPECT_NE(labelled.group_of(raw("a.bvh", "a.bvh")), labelled.group_of(raw("c.bvh", "c.bvh")));
    EXPECT_EQ(clips(labelled, "a.bvh", "a.bvh")[0].fields, (Names{"hug", "1"}));
}

TEST(ClipNames, RefusesWhatFitsNothing) {
    const auto error_of = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const Error& e) {
            return e.what();
        }
        return "none";
    };
    EXPECT_NE(error_of([] { ClipNames("", ""); }).find("give --name"), std::string::npos);
    ClipNames names("{action}_{n}", "");
    EXPECT_EQ(error_of([&] { names.settle(); }),
              "no file name fits the pattern '{action}_{n}'; there is no file");
    names.note(raw("walk.bvh", "walk.bvh"));
    EXPECT_EQ(error_of([&] { names.settle(); }),
              "no file name fits the pattern '{action}_{n}'; there is 'walk'");
    const test::TempDir dir;
    test::write_file(dir / "labels.csv", "file,action\na,walk\n");
    ClipNames labelled("", dir / "labels.csv");
    labelled.note(raw("walk.bvh", "walk.bvh"));
    EXPECT_EQ(error_of([&] { labelled.settle(); }),
              (dir / "labels.csv").string() + ": no row is for any of the files; there is 'walk'");
}

}  // namespace
}  // namespace actformer::ingest
