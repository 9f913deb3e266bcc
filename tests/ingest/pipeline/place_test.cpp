// How what an ingest made gets to a folder that is there.
#include "ingest/pipeline/place.hpp"

#include <gtest/gtest.h>

#include "tests/support/error_of.hpp"
#include "tests/support/tree.hpp"

using namespace actformer;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

struct Place : testing::Test {
    void SetUp() override {
        for (const auto* file : {"one/shard", "two/shard", "ingest.json"}) write_file(data() / file, file);
        right = tree(data());
    }
    fs::path out() const { return dir / "out"; }
    fs::path work() const { return dir / "out/.partial"; }
    fs::path data() const { return work() / "data"; }

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
    EXPECT_TRUE(fs::exists(out() / "one/shard"));
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
