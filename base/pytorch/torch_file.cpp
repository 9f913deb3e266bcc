#include "base/pytorch/torch_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/numpy/binary16.hpp"
#include "base/numpy/zip.hpp"
#include "base/pickle/pickle.hpp"
#include "base/text/html.hpp"
#include "base/text/printable.hpp"

namespace actformer {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie");

using Type = TorchTensor::Type;

/// The older form begins with a pickle of this whole number.
constexpr std::string_view old_magic("\x80\x02\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19.", 15);
constexpr std::int64_t old_version = 1001;
constexpr std::string_view zip_begin = "PK";
constexpr const char* other_order = "numbers with their highest byte first; save it on another machine";
constexpr std::size_t deepest_group = 8, most_entries = std::size_t{1} << 20;
constexpr std::int64_t most_numbers = std::int64_t{1} << 40;

// A pickle says a key, a shape or a storage once for any number of tensors, each of which has them for itself.
constexpr std::size_t longest_name = 1000, most_dimensions = 32;

// Inflated members keep their memory, and many may be the same bytes of the archive. All of them together are either that many bytes, or
// that many times the archive: of weights deflate makes hardly less.
constexpr std::uint64_t most_inflated = std::uint64_t{64} << 20, most_growth = 100;

// All tensors together are either most_inflated bytes, or that many times what the file and its inflated members hold: tied weights and
// views share storages a few times.
constexpr std::uint64_t most_sharing = 8;

std::size_t size_of(Type type) {
    switch (type) {
        case Type::float32:
            return 4;
        case Type::float16:
            return 2;
        case Type::float64:
        case Type::int64:
            break;
    }
    return 8;
}

PickleLimits limits() {
    PickleLimits limits;
    limits.tensors = true;
    return limits;
}

/// Runs `read` and says in which part of the file it failed.
template <typename Read>
auto within(const std::string& part, const Read& read) {
    try {
        return read();
    } catch (const Error& e) {
        throw Error("{}: {}", part, e.what());
    }
}

Type type_of(const PickleValue& storage_class) {
    const auto what = storage_class.what();
    for (const auto& [name, type] : {std::pair{"Float", Type::float32}, std::pair{"Double", Type::float64},
                                     std::pair{"Half", Type::float16}, std::pair{"Long", Type::int64}})
        if (what == fmt::format("the name torch {}Storage", name)) return type;
    throw Error("byte {}: {} for a class of storages", storage_class.at(), what);
}

/// A key behind `before` bytes of names. Throws Error for what is longer than a name, before it is copied.
std::string short_text(const PickleValue& key, std::size_t before = 0) {
    const auto size = before + key.bytes().size();
    if (size > longest_name)
        throw Error("byte {}: a name of {} bytes, where {} are enough: made to exhaust its readers", key.at(),
                    size, longest_name);
    return key.text();
}

/// What a storage is called by: ('storage', class, key, location, numbers), and in the older form a view or None behind.
struct StorageId {
    Type type;
    std::string key;
    std::uint64_t numbers;

    std::uint64_t bytes() const { return numbers * size_of(type); }

    explicit StorageId(const PickleValue& reference) {
        const auto id = reference.reference();
        if (!id || !id->is_sequence() || id->size() < 5 || !(*id)[0].is_text() ||
            (*id)[0].bytes() != "storage")
            throw Error("byte {}: {} where a storage belongs", reference.at(), reference.what());
        if (id->size() > 5 && !(*id)[5].is_none())
            throw Error("byte {}: a view of a storage, as PyTorch below 0.4 writes it; load and save it anew",
                        reference.at());
        type = type_of((*id)[1]);
        key = short_text((*id)[2]);
        const auto count = (*id)[4].whole();
        if (count < 0 || count > most_numbers)
            throw Error("byte {}: a storage of {} numbers", reference.at(), count);
        numbers = static_cast<std::uint64_t>(count);
    }
};

/// A storage's bytes, by its id.
using Storages = std::function<std::string_view(const StorageId&)>;

std::vector<std::uint64_t> whole_numbers(const PickleValue& list) {
    if (list.size() > most_dimensions)
        throw Error(
            "byte {}: {} numbers in a tensor's shape or strides, where {} are enough: made to exhaust "
            "its readers",
            list.at(), list.size(), most_dimensions);
    std::vector<std::uint64_t> out;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto number = list[i].whole();
        if (number < 0) throw Error("byte {}: {} in a tensor's shape or strides", list.at(), number);
        out.push_back(static_cast<std::uint64_t>(number));
    }
    return out;
}

/// Throws Error where a tensor reaches beyond `count` numbers, or has more numbers than there are.
void check_reach(const TorchTensor& tensor, std::uint64_t offset, std::uint64_t count, std::uint64_t at) {
    const auto fail = [&] {
        throw Error("byte {}: a tensor ({}) from number {} on reaches beyond its storage of {}: damaged", at,
                    fmt::join(tensor.shape, ", "), offset, count);
    };
    if (tensor.shape.size() != tensor.strides.size()) fail();
    if (offset > count) fail();
    std::uint64_t elements = 1, last = offset;
    for (const auto length : tensor.shape)
        if (length == 0) return;
    for (std::size_t i = 0; i < tensor.shape.size(); ++i) {
        const auto length = tensor.shape[i], stride = tensor.strides[i];
        if (length > count / elements) fail();
        elements *= length;
        if (length > 1 && stride > (count - std::min(last, count)) / (length - 1)) fail();
        last += (length - 1) * stride;
    }
    if (last >= count) fail();
}

/// _rebuild_tensor_v2(storage, offset, shape, strides, ...), of which _rebuild_parameter may be made.
bool is_tensor(const PickleValue& value) {
    return value.is_call("torch._utils _rebuild_tensor_v2") ||
           value.is_call("torch._utils _rebuild_tensor") || value.is_call("torch._utils _rebuild_parameter");
}

TorchTensor tensor_of(const PickleValue& value, const Storages& storages) {
    if (value.is_call("torch._utils _rebuild_parameter")) {
        const auto inner = value[0];
        if (!is_tensor(inner) || inner.is_call("torch._utils _rebuild_parameter"))
            throw Error("byte {}: a parameter without its tensor", value.at());
        return tensor_of(inner, storages);
    }
    const StorageId id(value[0]);
    TorchTensor tensor;
    tensor.type = id.type;
    tensor.shape = whole_numbers(value[2]);
    tensor.strides = whole_numbers(value[3]);
    const auto offset = value[1].whole();
    if (offset < 0) throw Error("byte {}: a tensor that begins at number {}", value.at(), offset);
    check_reach(tensor, static_cast<std::uint64_t>(offset), id.numbers, value.at());
    tensor.numbers = storages(id).substr(static_cast<std::uint64_t>(offset) * size_of(tensor.type));
    return tensor;
}

std::uint64_t bytes_of(const TorchTensor& tensor) {
    return std::accumulate(tensor.shape.begin(), tensor.shape.end(), std::uint64_t{size_of(tensor.type)},
                           std::multiplies<>());
}

/// Collects the tensors of a dict and of the dicts in it.
class Collector {
  public:
    /// `held`: bytes of the file and of what was inflated of it so far.
    Collector(const Storages& storages, const std::uint64_t& held, std::vector<TorchTensor>& to)
        : storages_(storages), held_(held), to_(to) {}

    void take(const PickleValue& dict, const std::string& group, std::size_t depth) {
        for (std::size_t i = 0; i < dict.size(); ++i) {
            if (++entries_ > most_entries)
                throw Error("byte {}: dicts of more than {} entries: made to exhaust its readers", dict.at(),
                            most_entries);
            const auto [key, value] = dict.entry(i);
            if (!key.is_text()) continue;  // an optimiser's numbered parameters
            if (is_tensor(value)) {
                auto tensor = tensor_of(value, storages_);
                tensor.group = group;
                tensor.name = short_text(key, group.size());
                count(tensor, value.at());
                to_.push_back(std::move(tensor));
            } else if (value.is_dict() && depth < deepest_group) {
                const auto name = short_text(key, group.size());
                take(value, group.empty() ? name : group + "/" + name, depth + 1);
            }
        }
    }

  private:
    void count(const TorchTensor& tensor, std::uint64_t at) {
        bytes_ += bytes_of(tensor) + tensor.group.size() + tensor.name.size();
        if (const auto most = std::max(most_inflated, most_sharing * held_); bytes_ > most)
            throw Error(
                "byte {}: more than {} MiB of tensors, in storages of {} MiB that they share: made to "
                "exhaust its readers; save copies of them if that is right",
                at, most >> 20, held_ >> 20);
    }

    const Storages& storages_;
    const std::uint64_t& held_;
    std::vector<TorchTensor>& to_;
    std::size_t entries_ = 0;  ///< seen so far, for dicts may hold one another many times
    std::uint64_t bytes_ = 0;  ///< of the tensors so far, with their names
};

void collect(const PickleValue& root, const Storages& storages, const std::uint64_t& held,
             std::vector<TorchTensor>& to) {
    if (!root.is_dict())
        throw Error("byte {}: {}, where a dict of tensors belongs; save a model's state_dict()", root.at(),
                    root.what());
    Collector(storages, held, to).take(root, "", 0);
}

/// A zip archive: NAME/data.pkl, and NAME/data/KEY for each storage.
class Archive {
  public:
    Archive(std::string_view bytes, std::deque<std::vector<char>>& unpacked)
        : unpacked_(unpacked),
          room_(std::max(most_inflated, most_growth * bytes.size())),
          held_(bytes.size()) {
        for (auto& member : zip_members(bytes)) members_.emplace(member.name, member);
    }

    std::vector<TorchTensor> tensors() {
        constexpr std::string_view pickle_name = "data.pkl";
        const auto found = std::ranges::find_if(members_, [&](const auto& one) {
            return one.first == pickle_name || one.first.ends_with("/data.pkl");
        });
        if (found == members_.end())
            throw Error("a zip archive without data.pkl: not a file of torch.save; TorchScript is not read");
        folder_ = found->first.substr(0, found->first.size() - pickle_name.size());
        if (const auto order = members_.find(folder_ + "byteorder");
            order != members_.end() && text_of(order->second) != "little")
            throw Error("{}", other_order);
        std::vector<TorchTensor> tensors;
        within(found->first, [&] {
            const Pickle pickle(text_of(found->second), limits());
            collect(
                pickle.root(), [&](const StorageId& id) { return storage(id); }, held_, tensors);
        });
        return tensors;
    }

  private:
    std::string_view storage(const StorageId& id) {
        const auto name = folder_ + "data/" + id.key;
        const auto member = members_.find(name);
        if (member == members_.end()) throw Error("no storage {} in the archive: damaged", in_quotes(id.key));
        if (member->second.size != id.bytes())
            throw Error("storage {} has {} bytes where {} numbers belong: damaged", in_quotes(id.key),
                        member->second.size, id.numbers);
        auto text = texts_.find(name);
        if (text == texts_.end()) text = texts_.emplace(name, text_of(member->second)).first;
        return text->second;
    }

    /// Inflates no more of it than the archive says that there is, and one byte, which tells that it is not so.
    std::string_view text_of(const ZipMember& member) {
        return within(member.name, [&] {
            if (member.deflated && member.size > room_)
                throw Error(
                    "it would take {} MiB more than the whole archive accounts for: made to exhaust its "
                    "readers; save it uncompressed if that is right",
                    (member.size - room_) >> 20);
            if (member.deflated) {
                room_ -= member.size;
                held_ += member.size;
            }
            const auto text = zip_text(member, unpacked_.emplace_back(), member.size + 1);
            if (text.size() != member.size) throw Error("longer than the archive says: damaged");
            return text;
        });
    }

    std::deque<std::vector<char>>& unpacked_;
    std::uint64_t room_;  ///< bytes that may still be inflated
    std::uint64_t held_;  ///< bytes of the archive, and those inflated so far
    std::map<std::string, ZipMember> members_;
    std::string folder_;
    std::map<std::string, std::string_view> texts_;
};

/// Pickles one behind another.
class Pickles {
  public:
    Pickles(std::string_view bytes, std::size_t from) : bytes_(bytes), at_(from) {}

    std::size_t at() const { return at_; }

    Pickle next() {
        return within(fmt::format("the pickle from byte {} on", at_), [&] {
            Pickle pickle(bytes_.substr(at_), limits());
            at_ += pickle.size();
            return pickle;
        });
    }

    /// Bytes between them.
    std::string_view take(std::uint64_t count) {
        if (count > bytes_.size() - at_) throw Error("{} bytes belong behind byte {}: cut short", count, at_);
        const auto taken = bytes_.substr(at_, count);
        at_ += count;
        return taken;
    }

  private:
    std::string_view bytes_;
    std::size_t at_;
};

std::string_view storage_named(const std::map<std::string, std::string_view>& storages, const StorageId& id) {
    const auto found = storages.find(id.key);
    if (found == storages.end()) throw Error("storage {} is missing: damaged", in_quotes(id.key));
    if (found->second.size() != id.bytes())
        throw Error("storage {} is of several sizes: damaged", in_quotes(id.key));
    return found->second;
}

/// Each storage's count and numbers, in the order of `keys`.
std::map<std::string, std::string_view> old_storages(const PickleValue& keys,
                                                     const std::map<std::string, StorageId>& ids,
                                                     Pickles& pickles) {
    std::map<std::string, std::string_view> storages;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto key = keys[i].text();
        const auto id = ids.find(key);
        if (id == ids.end()) throw Error("storage {} is no tensor's: damaged", in_quotes(key));
        std::uint64_t count = 0;
        std::memcpy(&count, pickles.take(sizeof count).data(), sizeof count);
        if (count != id->second.numbers)
            throw Error("storage {} has {} numbers where {} belong: damaged", in_quotes(key), count,
                        id->second.numbers);
        storages[key] = pickles.take(id->second.bytes());
    }
    return storages;
}

/// A magic number, a version, a description of the machine, the object, the storages' keys, and each storage's count and numbers.
std::vector<TorchTensor> read_old(std::string_view bytes) {
    Pickles pickles(bytes, old_magic.size());
    const auto version = pickles.next();
    if (const auto number = version.root().whole(); number != old_version)
        throw Error("version {} of PyTorch's older form; {} is known", number, old_version);
    const auto machine = pickles.next();
    if (const auto little = machine.root().is_dict() ? machine.root().find("little_endian") : std::nullopt;
        little && !little->truth())
        throw Error("{}", other_order);
    const auto part = fmt::format("the pickle from byte {} on", pickles.at());
    const auto object = pickles.next();
    const auto keys = pickles.next();
    // Storages lie in the order of their keys; tensors alone tell how large their numbers are, also those that nobody asks for.
    std::map<std::string, StorageId> ids;
    within(part, [&] {
        for (const auto& reference : object.references()) {
            const StorageId id(reference);
            ids.emplace(id.key, id);
        }
    });
    const auto storages = old_storages(keys.root(), ids, pickles);
    std::vector<TorchTensor> tensors;
    const std::uint64_t held = bytes.size();
    within(part, [&] {
        collect(
            object.root(), [&](const StorageId& id) { return storage_named(storages, id); }, held, tensors);
    });
    return tensors;
}

template <typename Number>
float number_at(std::string_view numbers, std::uint64_t place) {
    Number number;
    std::memcpy(&number, numbers.data() + place * sizeof number, sizeof number);
    return static_cast<float>(number);
}

float number_at(Type type, std::string_view numbers, std::uint64_t place) {
    switch (type) {
        case Type::float32:
            return number_at<float>(numbers, place);
        case Type::float64:
            return number_at<double>(numbers, place);
        case Type::int64:
            return number_at<std::int64_t>(numbers, place);
        case Type::float16:
            break;
    }
    std::uint16_t bits = 0;
    std::memcpy(&bits, numbers.data() + 2 * place, sizeof bits);
    return static_cast<float>(of_binary16(bits));
}

}  // namespace

std::vector<float> TorchTensor::values() const {
    std::vector<float> out;
    if (std::ranges::find(shape, 0U) != shape.end()) return out;
    std::vector<std::uint64_t> index(shape.size(), 0);
    std::uint64_t place = 0;
    for (bool more = true; more;) {
        out.push_back(number_at(type, numbers, place));
        more = false;
        for (auto axis = shape.size(); axis-- > 0 && !more;) {  // as an odometer
            place += strides[axis];
            more = ++index[axis] < shape[axis];
            if (!more) place -= strides[axis] * std::exchange(index[axis], 0);
        }
    }
    return out;
}

TorchFile::TorchFile(std::string_view bytes) {
    if (bytes.starts_with(old_magic))
        tensors_ = read_old(bytes);
    else if (bytes.starts_with(zip_begin))
        tensors_ = Archive(bytes, unpacked_).tensors();
    else if (is_html(bytes))
        throw Error("{}", html_in_place_of("weights"));
    else
        throw Error("neither a zip archive of torch.save nor its older form");
}

}  // namespace actformer
