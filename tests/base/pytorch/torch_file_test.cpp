// Files of torch.save in its older form, made byte by byte: what they hold, and what must be refused. Files of PyTorch itself, zip archives
// too, are in tests/model/import_test.cpp.
#include "base/pytorch/torch_file.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "base/error.hpp"
#include "base/pickle/pickle.hpp"
#include "tests/support/pickle_text.hpp"

using namespace actformer;
using namespace actformer::test::pickled;

namespace {

const std::string magic("\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19.", 15);

template <typename Number>
std::string bytes_of(const std::vector<Number>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

std::string tuple(const std::vector<std::string>& values) {
    std::string out = "(";
    for (const auto& value : values) out += value;
    return out + "t";
}

std::string tuple_of(const std::vector<int>& numbers) {
    std::vector<std::string> values;
    for (const auto number : numbers) values.push_back(whole(number));
    return tuple(values);
}

std::string storage(const std::string& type, const std::string& key, int count) {
    return tuple({text("storage"), "ctorch\n" + type + "Storage\n", text(key), text("cpu"), whole(count),
                  "N"}) +
           "Q";
}

struct Tensor {
    std::string type = "Float", key = "7";
    int count = 6, offset = 0;
    std::vector<int> shape{2, 3}, strides{3, 1};

    std::string pickled() const {
        return "ctorch._utils\n_rebuild_tensor_v2\n" +
               tuple({storage(type, key, count), whole(offset), tuple_of(shape), tuple_of(strides), "\x89",
                      "}"}) +
               "R";
    }
};

struct Stored {
    std::string key;
    std::uint64_t count;
    std::string bytes;
};

std::string old_file(const std::string& object, const std::vector<Stored>& storages) {
    std::vector<std::string> keys;
    std::string numbers;
    for (const auto& one : storages) {
        keys.push_back(text(one.key));
        numbers += bytes_of<std::uint64_t>({one.count}) + one.bytes;
    }
    return magic + file(whole(1001)) + file(dict({{"little_endian", "\x88"}})) + file(object) +
           file(list(keys)) + numbers;
}

const Stored six{"7", 6, bytes_of<float>({1, 2, 3, 4, 5, 6})};

std::string fault_of(const std::string& bytes) {
    try {
        const TorchFile torch(bytes);
        for (const auto& tensor : torch.tensors()) tensor.values();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

void expect_fault(const std::string& bytes, const std::string& words) {
    EXPECT_NE(fault_of(bytes).find(words), std::string::npos) << fault_of(bytes);
}

using Floats = std::vector<float>;

}  // namespace

TEST(TorchFile, ReadsViewsOfSharedStorages) {
    const auto bytes = old_file(dict({{"a", Tensor{}.pickled()},
                                      {"turned", Tensor{.shape = {3, 2}, .strides = {1, 3}}.pickled()},
                                      {"part", Tensor{.offset = 4, .shape = {2}, .strides = {1}}.pickled()},
                                      {"one", Tensor{.offset = 5, .shape = {}, .strides = {}}.pickled()},
                                      {"none", Tensor{.shape = {0, 3}, .strides = {3, 1}}.pickled()}}),
                                {six});
    const TorchFile torch(bytes);
    ASSERT_EQ(torch.tensors().size(), 5U);
    const auto values = [&](std::size_t i) { return torch.tensors()[i].values(); };
    EXPECT_EQ(values(0), (Floats{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(values(1), (Floats{1, 4, 2, 5, 3, 6}));
    EXPECT_EQ(values(2), (Floats{5, 6}));
    EXPECT_EQ(values(3), (Floats{6}));
    EXPECT_EQ(values(4), Floats{});
    EXPECT_EQ(torch.tensors()[1].name, "turned");
    EXPECT_EQ(torch.tensors()[1].shape, (std::vector<std::uint64_t>{3, 2}));
}

TEST(TorchFile, ReadsTypesParametersAndDictsInDicts) {
    const Tensor doubles{"Double", "d", 2, 0, {2}, {1}}, halves{"Half", "h", 4, 0, {4}, {1}},
        wholes{"Long", "w", 1, 0, {}, {}};
    const auto parameter = "ctorch._utils\n_rebuild_parameter\n" +
                           tuple({doubles.pickled(), "\x88", "ccollections\nOrderedDict\n)R"}) + "R";
    const auto state = "ccollections\nOrderedDict\n)R(" + text("h") + halves.pickled() + "u" +
                       dict({{"_metadata", dict({})}}) + "b";  // attributes of a state_dict
    const auto bytes = old_file(
        dict(
            {{"net", dict({{"p", parameter}, {"in", state}})}, {"epoch", whole(3)}, {"w", wholes.pickled()}}),
        {{"d", 2, bytes_of<double>({0.5, -3})},
         {"h", 4, bytes_of<std::uint16_t>({0x3C00, 0xC000, 0x0001, 0x3555})},
         {"w", 1, bytes_of<std::int64_t>({-12})}});
    const TorchFile torch(bytes);
    ASSERT_EQ(torch.tensors().size(), 3U);
    EXPECT_EQ(torch.tensors()[0].group + ":" + torch.tensors()[0].name, "net:p");
    EXPECT_EQ(torch.tensors()[0].values(), (Floats{0.5, -3}));
    EXPECT_EQ(torch.tensors()[1].group + ":" + torch.tensors()[1].name, "net/in:h");
    EXPECT_EQ(torch.tensors()[1].values(), (Floats{1, -2, 0x1p-24F, 1365 * 0x1p-12F}));
    EXPECT_EQ(torch.tensors()[2].group, "");
    EXPECT_EQ(torch.tensors()[2].values(), Floats{-12});
}

TEST(TorchFile, PassesOverTensorsThatNobodyAsksFor) {
    // An optimiser's state goes by the parameters' numbers, its lists have no keys at all.
    const auto moments = "}(" + whole(0) + Tensor{.key = "m"}.pickled() + "u";
    const auto bytes =
        old_file(dict({{"optimiser", dict({{"state", moments}})},
                       {"steps", list({Tensor{"Long", "s", 1, 0, {1}, {1}}.pickled()})},
                       {"model", dict({{"a", Tensor{}.pickled()}})}}),
                 {{"7", 6, six.bytes}, {"m", 6, six.bytes}, {"s", 1, bytes_of<std::int64_t>({9})}});
    const TorchFile torch(bytes);
    ASSERT_EQ(torch.tensors().size(), 1U);
    EXPECT_EQ(torch.tensors()[0].group, "model");
    EXPECT_EQ(torch.tensors()[0].values(), (Floats{1, 2, 3, 4, 5, 6}));
}

TEST(TorchFile, RunsNothing) {
    const auto fault =
        fault_of(old_file(dict({{"a", "cposix\nsystem\n" + tuple({text("touch /tmp/x")}) + "R"}}), {}));
    EXPECT_NE(fault.find("posix system at byte "), std::string::npos) << fault;
    EXPECT_NE(fault.find("nothing was run"), std::string::npos) << fault;
    expect_fault(old_file(dict({{"a", "ctorch\nload\n" + tuple({text("x")}) + "R"}}), {}),
                 "torch load at byte ");
    // Other readers of pickles know no tensors.
    const auto alone = file(dict({{"a", Tensor{}.pickled()}}));
    EXPECT_THROW(Pickle{alone}, Error);
}

TEST(TorchFile, RefusesTensorsBeyondTheirStorages) {
    const std::string beyond = "reaches beyond its storage of 6";
    for (const auto& tensor : {Tensor{.offset = 1}, Tensor{.offset = 7}, Tensor{.strides = {4, 1}},
                               Tensor{.shape = {7}, .strides = {0}}, Tensor{.shape = {2, 3, 1}},
                               Tensor{.shape = {1 << 30, 1 << 30, 1 << 30}, .strides = {1, 1, 1}},
                               Tensor{.strides = {2147483647, 2147483647}}})
        expect_fault(old_file(dict({{"a", tensor.pickled()}}), {six}), beyond);
    expect_fault(old_file(dict({{"a", Tensor{.offset = -1}.pickled()}}), {six}), "begins at number -1");
    expect_fault(old_file(dict({{"a", Tensor{.shape = {-2, 3}}.pickled()}}), {six}), "shape or strides");
    expect_fault(old_file(dict({{"a", Tensor{.count = -6}.pickled()}}), {six}), "a storage of -6 numbers");
}

TEST(TorchFile, RefusesWhatIsDamagedOrCutShort) {
    const auto whole_file = old_file(dict({{"a", Tensor{}.pickled()}}), {six});
    EXPECT_EQ(fault_of(whole_file), "");
    for (std::size_t size = 0; size < whole_file.size(); ++size)
        EXPECT_NE(fault_of(whole_file.substr(0, size)), "") << size << " bytes";
    expect_fault(whole_file.substr(0, whole_file.size() - 1), "cut short");
    expect_fault(old_file(dict({{"a", Tensor{}.pickled()}}), {{"7", 5, six.bytes}}),
                 "5 numbers where 6 belong");
    expect_fault(old_file(dict({{"a", Tensor{}.pickled()}}), {{"8", 6, six.bytes}}), "no tensor's");
    expect_fault(old_file(dict({{"a", Tensor{}.pickled()}}), {}), "storage '7' is missing");
    expect_fault(old_file(whole(4), {}), "a dict of tensors belongs");
    expect_fault(magic + file(whole(1000)), "version 1000");
    expect_fault(magic + file(whole(1001)) + file(dict({{"little_endian", "\x89"}})), "highest byte first");
    expect_fault("<!DOCTYPE html><html>", "HTML");
    expect_fault("weights", "neither a zip archive");
    expect_fault("PK\x03\x04", "zip archive");
}
