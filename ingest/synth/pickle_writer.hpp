// Python pickles of protocol 4, written: dictionaries, lists, texts, numbers and NumPy arrays.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest::synth {

/// Values follow one another; those inside a dictionary are a key and its value by turns.
///
///   PickleWriter p;
///   p.dict([&] { p.text("y"); p.list([&] { p.integer(3); }); });
///   const std::string bytes = p.finish();
class PickleWriter {
  public:
    using Shape = std::vector<std::uint64_t>;

    PickleWriter();

    template <typename Fill>
    void dict(Fill fill) {
        text_ += "}(";
        fill();
        text_ += 'u';
    }

    template <typename Fill>
    void list(Fill fill) {
        text_ += "](";
        fill();
        text_ += 'e';
    }

    void text(std::string_view value);
    void integer(std::int32_t value);
    void number(double value);
    void none() { text_ += 'N'; }

    /// In C order. Throws nothing: the shape's product must be the number of values.
    void array(const Shape& shape, std::span<const double> values);
    void array(const Shape& shape, std::span<const float> values);
    void array(const Shape& shape, std::span<const std::int64_t> values);

    std::string finish();

  private:
    void array_of(const Shape& shape, std::string_view type, std::string_view bytes);
    std::string text_;
};

}  // namespace actformer::ingest::synth
