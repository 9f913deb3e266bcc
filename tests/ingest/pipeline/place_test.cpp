// How what an ingest made gets to a folder that is there.
#include "ingest/pipeline/place.hpp"

#include <gtest/gtest.h>

#include "base/checksum/checksum.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/tree.hpp"

using namespace actformer;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

struct Place : testing::Test {
    void SetUp() override {
        for (const auto* file : {"one/shard-0", "two/shard-0", "ingest.json"})
            write_file(data() / file, file);
        right = tree(data());
    }
    fs::path out() const { return dir / "out"; }
    fs::path work() const { return dir / "out/.partial"; }
    fs::path data() const { return work() / "data"; }

    /// The list of what may have been moved up: `names`, each behind a zero byte, and their checksum.
    void list(const std::string& names) const { write_file(work() / "delivering", checksum(names) + names); }

    /// What take_back() says where it moves nothing.
    std::string refusal() const {
        const auto before = tree(dir.path());
        const auto why = error_of([&] { ingest::take_back(data(), work()); });
        EXPECT_EQ(tree(dir.path()), before) << why;
        return why;
    }

    TempDir dir;
    std::map<std::string, std::string> right;
};

}  // namespace

TEST_F(Place, WorksInsideAFolderAndBesideWhatIsNone) {
    EXPECT_EQ(ingest::workplace_of(out()), work());
    EXPECT_EQ(ingest::workplace_of(dir / "none"), dir / "none.partial");
    fs::create_symlink("far", dir / "link");
    EXPECT_EQ(ingest::workplace_of(dir / "link"), dir / "far.partial");
    EXPECT_FALSE(ingest::is_taken(out()));
    EXPECT_FALSE(ingest::is_taken(dir / "none"));
    write_file(out() / "thesis", "text");
    EXPECT_TRUE(ingest::is_taken(out()));
    EXPECT_TRUE(ingest::is_taken(out() / "thesis"));
}

TEST_F(Place, MovesUpAllOrTakesItBack) {
    fs::create_directories(out() / "two/taken");  // so that the second cannot be moved up
    EXPECT_NE(error_of([&] {
                  ingest::put_in_place(data(), work(), out());
              }).find("out/two: cannot be put in place"),
              std::string::npos);
    EXPECT_TRUE(fs::exists(out() / "one/shard-0"));
    EXPECT_FALSE(ingest::is_taken(out())) << "the next run goes on";
    fs::remove_all(out() / "two");
    write_file(out() / "thesis", "precious");
    ingest::take_back(data(), work());
    EXPECT_EQ(tree(data()), right);
    EXPECT_EQ(read_file(out() / "thesis"), "precious");
    ingest::put_in_place(data(), work(), out());
    fs::remove_all(work());
    fs::remove(out() / "thesis");
    EXPECT_EQ(tree(out()), right);
}

TEST_F(Place, ReplacesNothing) {
    write_file(out() / "ingest.json", "somebody's");
    const auto why = error_of([&] { ingest::put_in_place(data(), work(), out()); });
    EXPECT_NE(why.find("out/ingest.json: cannot be put in place: something is there; move it, or choose"),
              std::string::npos)
        << why;
    ingest::take_back(data(), work());
    EXPECT_EQ(tree(data()), right);
    EXPECT_EQ(read_file(out() / "ingest.json"), "somebody's") << "it was not moved up";
}

TEST_F(Place, TakesNothingBackByAListThatIsNotItsOwn) {
    using namespace std::string_literals;
    write_file(dir / "home/docs/thesis.txt", "precious");
    write_file(out() / "one.txt", "precious");
    fs::create_directory_symlink("../home/docs", out() / "a");
    fs::create_directories(data() / "a");
    const auto expect_damaged = [&](const std::string& names) {
        const auto why = refusal();
        EXPECT_NE(why.find("out/.partial/delivering: damaged"), std::string::npos) << names << why;
        EXPECT_NE(why.find("or choose another -o"), std::string::npos) << names << why;
    };
    for (const auto& names : {"\0a/thesis.txt"s, "\0../home"s, "\0.."s, "\0."s, "\0"s, "\0.partial"s,
                              "\0/etc"s, "\0one.txt\0a/"s}) {
        write_file(work() / "delivering", names);
        expect_damaged(names);
        list(names);
        expect_damaged(names);
    }
    write_file(work() / "delivering", checksum("\0one.txt"s) + "\0two.txt"s);
    expect_damaged("another's checksum");
    write_file(work() / "delivering", "");
    expect_damaged("cut");
}

TEST_F(Place, TakesNothingBackThatOthersMade) {
    using namespace std::string_literals;
    fs::rename(data() / "one", out() / "one");
    fs::rename(data() / "two", out() / "two");
    list("\0one\0two\0three\0ingest.json"s);
    write_file(out() / "two/thesis.txt", "precious");
    EXPECT_NE(refusal().find("out/two/thesis.txt: "), std::string::npos);
    fs::remove(out() / "two/thesis.txt");
    write_file(dir / "home/shard-0", "precious");
    fs::create_directory_symlink("../home", out() / "three");
    EXPECT_NE(refusal().find("out/three: a symbolic link"), std::string::npos);
    fs::remove(out() / "three");
    write_file(out() / "three", "precious");
    EXPECT_NE(refusal().find("out/three: in the way"), std::string::npos);
    fs::remove(out() / "three");
    ingest::take_back(data(), work());
    EXPECT_EQ(tree(data()), right);
    EXPECT_FALSE(fs::exists(work() / "delivering"));
}

TEST_F(Place, TakesNothingBackToAWorkplaceBesideOut) {
    using namespace std::string_literals;
    fs::rename(work(), dir / "made.partial");
    write_file(dir / "shard-0", "precious");
    write_file(dir / "made.partial/delivering", checksum("\0shard-0"s) + "\0shard-0"s);
    ingest::take_back(dir / "made.partial/data", dir / "made.partial");
    EXPECT_EQ(read_file(dir / "shard-0"), "precious") << "it lies beside OUT";
}

TEST_F(Place, TellsWhereIngestsWork) {
    write_file(dir / "none.partial/journal", "");
    write_file(dir / "others.partial/thesis", "");
    EXPECT_EQ(ingest::own_folders(out()), (std::vector{out(), work(), dir / "out.partial"}));
    EXPECT_EQ(ingest::own_folders(dir / "none"),
              (std::vector{dir / "none", dir / "none.partial", dir / "none.partial"}));
    EXPECT_EQ(ingest::own_folders(dir / "others"), std::vector{dir / "others"});
}
