// Names of arrays out of files of torch.save, made byte by byte. Files of PyTorch itself are in tests/model/import_test.cpp.
#include "model/nn/torch_arrays.hpp"

#include <gtest/gtest.h>

#include "tests/support/error_of.hpp"
#include "tests/support/pickle_text.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::model {
namespace {

namespace pickled = test::pickled;

/// A file of one tensor, a number 2 that any names of `object` are for.
void write_torch_file(const std::filesystem::path& path, const std::string& object) {
    const float two = 2;
    std::string numbers("\1\0\0\0\0\0\0\0", 8);
    numbers.append(reinterpret_cast<const char*>(&two), sizeof two);
    test::write_file(path, std::string("\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19.", 15) +
                               pickled::file(pickled::whole(1001)) + pickled::file(pickled::dict({})) +
                               pickled::file(object) + pickled::file(pickled::list({pickled::text("0")})) +
                               numbers);
}

std::string one_number() {
    return "ctorch._utils\n_rebuild_tensor_v2\n((" + pickled::text("storage") + "ctorch\nFloatStorage\n" +
           pickled::text("0") + pickled::text("cpu") + pickled::whole(1) + "tQ" + pickled::whole(0) +
           "))\x89}tR";
}

std::string weight_in(const std::string& group) {
    return pickled::dict({{group, pickled::dict({{"weight", one_number()}})}});
}

std::string dots(std::size_t count) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i) out += "a.";
    return out + "a";
}

}  // namespace

TEST(TorchArrays, AreNamedByAllKeysOnTheirWay) {
    const test::TempDir dir;
    write_torch_file(dir / "w.pt", pickled::dict({{"model", weight_in("in.ner")}}));
    const auto file = read_torch_arrays(dir / "w.pt");
    ASSERT_EQ(file.arrays.size(), 1U);
    EXPECT_EQ(file.arrays[0].name, "model.in.ner.weight");
    EXPECT_EQ(file.prefixes, (std::vector<std::string>{"", "model.", "model.in.", "model.in.ner."}));
    EXPECT_EQ(file.behind("model.in.")[0].name, "ner.weight");
    EXPECT_EQ(std::get<std::vector<float>>(file.behind("model.")[0].values), std::vector<float>{2});
}

/// Their arrays are copied once a prefix.
TEST(TorchArrays, AreBehindFewPrefixes) {
    const test::TempDir dir;
    const auto fault = [&](const std::string& object) {
        write_torch_file(dir / "w.pt", object);
        return test::error_of([&] { read_torch_arrays(dir / "w.pt"); });
    };
    EXPECT_EQ(fault(weight_in(dots(31))), "");
    const auto deep = fault(weight_in(dots(32)));
    EXPECT_NE(deep.find("w.pt: tensors behind 33 names"), std::string::npos) << deep;
    std::vector<std::pair<std::string, std::string>> dicts;
    for (int i = 0; i < 1000; ++i)
        dicts.emplace_back(std::to_string(i), pickled::dict({{"w", one_number()}}));
    const auto wide = fault(pickled::dict(dicts));
    EXPECT_NE(wide.find("w.pt: tensors in more than 1000 dicts"), std::string::npos) << wide;
    dicts.pop_back();
    EXPECT_EQ(fault(pickled::dict(dicts)), "");
}

}  // namespace actformer::model
