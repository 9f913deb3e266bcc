#include "eval/stgcn/weights.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.hpp"
#include "base/hdf5/writer.hpp"
#include "tests/support/plain_recogniser.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;

namespace {

eval::StgcnWeights small() {
    return eval::random_stgcn_weights(6, 5, {test::small_tree, 0}, 0.0625, 1);
}

/// Writes what `change` makes of good weights; tensors taken out are left out.
struct Changed {
    test::TempDir folder;
    std::filesystem::path path = folder / "weights.h5";

    template <typename Change>
    explicit Changed(Change change) {
        auto weights = small();
        std::map<std::string, hdf5::Shape> shapes;
        for (const auto& tensor : eval::stgcn_tensors(weights))
            shapes[tensor.name].assign(tensor.shape.begin(), tensor.shape.end());
        change(weights, shapes);
        hdf5::Writer file(path);
        for (const auto& [name, values] : weights.tensors) file.write<float>(name, shapes.at(name), values);
        file.attribute("channels", std::int64_t{weights.channels});
        file.attribute("classes", std::int64_t{weights.classes});
        file.attribute("parents",
                       std::vector<std::int64_t>(weights.graph.parents.begin(), weights.graph.parents.end()));
        file.attribute("center", std::int64_t{weights.graph.center});
        file.finish();
    }

    std::string refusal() const {
        try {
            eval::read_stgcn_weights(path);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }
};

void expect_refusal(const Changed& file, const std::string& part) {
    const auto said = file.refusal();
    EXPECT_NE(said.find(part), std::string::npos) << said;
    EXPECT_NE(said.find(file.path.string()), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

}  // namespace

TEST(StgcnWeights, ComeBackAsTheyWereWritten) {
    const test::TempDir folder;
    const auto weights = small();
    write_stgcn_weights(folder / "w.h5", weights);
    const auto back = eval::read_stgcn_weights(folder / "w.h5");
    EXPECT_EQ(back.tensors, weights.tensors);
    EXPECT_EQ(back.graph, weights.graph);
    EXPECT_EQ(back.widths, weights.widths);
    EXPECT_EQ(back.channels, 6U);
    EXPECT_EQ(back.classes, 5U);
}

TEST(StgcnWeights, NameWhatIsWrong) {
    const std::string norm = "st_gcn_networks.4.residual.1.running_var";
    expect_refusal(Changed([&](auto& w, auto&) { w.tensors.erase(norm); }), norm);
    expect_refusal(Changed([](auto& w, auto&) { w.tensors.erase("st_gcn_networks.2.tcn.2.weight"); }),
                   "st_gcn_networks.2.tcn.2.weight");
    expect_refusal(Changed([](auto& w, auto& shapes) {
                       w.tensors["st_gcn_networks.1.residual.0.weight"] = std::vector<float>(16);
                       shapes["st_gcn_networks.1.residual.0.weight"] = {4, 4, 1, 1};
                   }),
                   "st_gcn_networks.1.residual.0.weight");
    expect_refusal(Changed([](auto&, auto& shapes) {
                       shapes["edge_importance.3"] = {3, 441, 1};
                   }),
                   "edge_importance.3");
    expect_refusal(Changed([](auto& w, auto& shapes) {
                       shapes["fcn.bias"] = {4};
                       w.tensors["fcn.bias"].resize(4);
                   }),
                   "fcn.bias");
    expect_refusal(
        Changed([](auto& w, auto&) { w.tensors["fcn.weight"][3] = std::numeric_limits<float>::quiet_NaN(); }),
        "fcn.weight");
    expect_refusal(Changed([&](auto& w, auto&) { w.tensors[norm][0] = -1; }), norm);
    expect_refusal(Changed([](auto& w, auto&) { w.classes = 4097; }), "4097 classes");
}

TEST(StgcnWeights, RefuseParentsThatAreNoTree) {
    expect_refusal(Changed([](auto& w, auto&) { w.graph.parents[5] = 6; }),
                   "no tree");  // 5 and 6 hang from each other
    expect_refusal(Changed([](auto& w, auto&) { w.graph.parents[5] = -1; }), "no tree");  // two roots
    expect_refusal(Changed([](auto& w, auto&) { w.graph.parents[5] = 40; }), "no tree");  // nobody
    expect_refusal(Changed([](auto& w, auto&) { w.graph.center = 21; }), "center");
    expect_refusal(Changed([](auto& w, auto&) { w.graph.parents.pop_back(); }),
                   "");  // fewer joints than the tensors
}

TEST(StgcnWeights, RefuseFilesThatAreNone) {
    const test::TempDir folder;
    EXPECT_THROW(eval::read_stgcn_weights(folder / "none.h5"), Error);
    test::write_file(folder / "text.h5", "no HDF5");
    EXPECT_THROW(eval::read_stgcn_weights(folder / "text.h5"), Error);
    hdf5::Writer(folder / "empty.h5").finish();
    EXPECT_THROW(eval::read_stgcn_weights(folder / "empty.h5"), Error);
}
