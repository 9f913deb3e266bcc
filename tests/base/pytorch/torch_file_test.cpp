// Files of torch.save, made byte by byte: what they hold, and what must be refused. Files of PyTorch itself are in
// tests/model/import_test.cpp.
#include "base/pytorch/torch_file.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>

#include "base/error.hpp"
#include "base/pickle/pickle.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/pickle_text.hpp"
#include "tests/support/zip_parts.hpp"

using namespace actformer;
using namespace actformer::test::pickled;
using actformer::test::deflate_raw, actformer::test::error_of, actformer::test::number;

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

/// A pickled value that says itself once, and then stands for itself in five bytes.
std::string remembered(const std::string& value) {
    return value + "r" + four(77);
}
const std::string the_remembered = "j" + four(77);

/// Tensors 0, 1, 2, ... that are all the same one.
std::string same_tensors(const Tensor& tensor, int count) {
    std::vector<std::pair<std::string, std::string>> all;
    for (int i = 0; i < count; ++i)
        all.emplace_back(std::to_string(i), i == 0 ? remembered(tensor.pickled()) : the_remembered);
    return dict(all);
}

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

/// A zip archive of torch.save: its list, and what that says of each storage.
class Zip {
  public:
    explicit Zip(const std::string& object) { add("data.pkl", file(object), false); }

    /// One that lies in the archive, deflated or not, as many bytes as it is or as `said`.
    void add(const std::string& name, const std::string& text, bool deflated, std::uint64_t said = 0) {
        const auto packed = deflated ? deflate_raw(text) : text;
        const auto size = said ? said : text.size();
        const auto sum = crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(size));
        last_ = number(deflated ? 8 : 0, 2) + number(0, 4) + number(sum, 4) + number(packed.size(), 4) +
                number(size, 4);
        at_ = members_.size();
        list_name(name);
        members_ += "PK\x03\x04" + number(20, 2) + number(0, 2) + last_ + number(name.size(), 2) +
                    number(0, 2) + name + packed;
    }

    /// The last one once more, by another name.
    void list_name(const std::string& name) {
        list_ += "PK\x01\x02" + number(20, 2) + number(20, 2) + number(0, 2) + last_ +
                 number(name.size(), 2) + number(0, 2 + 2 + 2 + 2 + 4) + number(at_, 4) + name;
        ++count_;
    }

    std::string bytes() const {
        return members_ + list_ + "PK\x05\x06" + number(0, 4) + number(count_, 2) + number(count_, 2) +
               number(list_.size(), 4) + number(members_.size(), 4) + number(0, 2);
    }

  private:
    std::string members_, list_, last_;
    std::size_t at_ = 0, count_ = 0;
};

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

TEST(TorchFile, ReadsStoragesOfAnArchive) {
    for (const bool deflated : {false, true}) {
        Zip zip(dict(
            {{"a", Tensor{}.pickled()}, {"b", Tensor{.offset = 5, .shape = {}, .strides = {}}.pickled()}}));
        zip.add("data/7", six.bytes, deflated);
        zip.add("byteorder", "little", deflated);
        const auto bytes = zip.bytes();
        const TorchFile torch(bytes);
        ASSERT_EQ(torch.tensors().size(), 2U);
        EXPECT_EQ(torch.tensors()[0].values(), (Floats{1, 2, 3, 4, 5, 6}));
        EXPECT_EQ(torch.tensors()[1].values(), Floats{6});
    }
}

TEST(TorchFile, InflatesNoMoreThanStoragesNeed) {
    const std::string zeros(std::size_t{32} << 20, '\0'), object = dict({{"a", Tensor{}.pickled()}});
    for (const bool deflated : {false, true}) {
        Zip zip(object);
        zip.add("data/7", zeros, deflated);
        expect_fault(zip.bytes(), "storage '7' has 33554432 bytes where 6 numbers belong: damaged");
    }
    Zip short_one(object), lies(object);
    short_one.add("data/7", six.bytes.substr(0, 20), true);
    expect_fault(short_one.bytes(), "storage '7' has 20 bytes where 6 numbers belong: damaged");
    lies.add("data/7", zeros, true, 24);
    expect_fault(lies.bytes(), "data/7: longer than the archive says: damaged");
}

TEST(TorchFile, InflatesNoMoreThanTheArchiveAccountsFor) {
    const int count = 6 << 20;
    std::vector<std::pair<std::string, std::string>> tensors;
    for (const auto* key : {"1", "2", "3"})
        tensors.emplace_back(key, Tensor{.key = key, .count = count}.pickled());
    const std::string zeros(std::size_t{4} * count, '\0');
    Zip apart(dict({tensors[0], tensors[1]})), again(dict(tensors));
    apart.add("data/1", zeros, true);
    apart.list_name("data/2");
    EXPECT_EQ(fault_of(apart.bytes()), "") << "48 MiB";
    again.add("data/1", zeros, true);
    again.list_name("data/2");
    again.list_name("data/3");
    expect_fault(again.bytes(), "data/3: it would take 8 MiB more than the whole archive accounts for");
}

TEST(TorchFile, ReadsStoragesThatTensorsShareAFewTimes) {
    const int count = 1 << 20;
    const Stored zeros{"7", std::uint64_t{count}, std::string(std::size_t{4} * count, '\0')};
    const Tensor tensor{.count = count, .shape = {count}, .strides = {1}};
    const auto few = old_file(same_tensors(tensor, 15), {zeros}),
               many = old_file(same_tensors(tensor, 16), {zeros});
    EXPECT_EQ(TorchFile(few).tensors().size(), 15U) << "60 MiB";
    const auto fault = error_of([&] { TorchFile{many}; });
    EXPECT_NE(fault.find("more than 64 MiB of tensors, in storages of 4 MiB"), std::string::npos) << fault;
}

TEST(TorchFile, RefusesNamesAndShapesThatOnlyTakeMemory) {
    const std::string enough = "bytes, where 1000 are enough";
    const auto name = [](std::size_t size) { return std::string(size, 'n'); };
    const auto named = [&](std::size_t size) { return dict({{name(size), Tensor{}.pickled()}}); };
    const auto in_group = [&](std::size_t size) { return dict({{name(size), named(500)}}); };
    EXPECT_EQ(fault_of(old_file(named(1000), {six})), "");
    EXPECT_EQ(fault_of(old_file(in_group(500), {six})), "");
    for (const auto& object : {named(1001), in_group(501), in_group(1001)})
        expect_fault(old_file(object, {six}), enough);
    expect_fault(old_file(dict({{"a", Tensor{.key = name(1001)}.pickled()}}), {six}), enough);
    const std::vector<int> ones(33, 1);
    expect_fault(old_file(dict({{"a", Tensor{.shape = ones, .strides = ones}.pickled()}}), {six}),
                 "33 numbers in a tensor's shape or strides");
    const Tensor none{.count = 0, .shape = {0}, .strides = {1}};
    expect_fault(old_file(dict({{name(900), same_tensors(none, 80'000)}}), {{"7", 0, ""}}),
                 "more than 64 MiB of tensors");
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
