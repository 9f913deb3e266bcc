// The sweeps that come with the program.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "reports/sweep/sweep_file.hpp"
#include "tests/support/paths.hpp"

using namespace actformer;
using namespace actformer::reports;
namespace fs = std::filesystem;

namespace {

std::set<std::string> cells_of(const Sweep& sweep) {
    std::set<std::string> cells;
    for (const auto& row : sweep.rows) cells.insert(row.fills.begin(), row.fills.end());
    return cells;
}

}  // namespace

TEST(ShippedSweeps, CanBeReadAndNameConfigurationsThatAreThere) {
    std::size_t sweeps = 0;
    for (const auto& file : fs::directory_iterator(test::source("reports/sweeps"))) {
        const auto sweep = read_sweep(file.path());
        ++sweeps;
        for (const auto& row : sweep.rows)
            EXPECT_TRUE(fs::exists(test::source(row.config))) << file.path() << ": " << row.config;
        for (const auto& [name, recogniser] : sweep.recognisers)
            EXPECT_TRUE(!recogniser.weights.empty() || fs::exists(test::source(recogniser.config)))
                << file.path() << ": " << recogniser.config;
    }
    EXPECT_GE(sweeps, 7U);
}

TEST(ShippedSweeps, OfTheTablesFillEveryCellThatThePaperHas) {
    const auto cells = [](const char* name) {
        return cells_of(read_sweep(test::source(std::string("reports/sweeps/") + name)));
    };
    EXPECT_EQ(cells("table1.yaml").size(), 16U);
    EXPECT_EQ(cells("table2.yaml").size(), 12U);
    EXPECT_EQ(cells("table3.yaml").size(), 4U);
    EXPECT_EQ(cells("table4.yaml").size(), 6U);
    EXPECT_EQ(cells("table5.yaml").size(), 15U);
    EXPECT_EQ(cells("mini.yaml").size(), 53U);
}
