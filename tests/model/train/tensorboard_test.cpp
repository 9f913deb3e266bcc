// TensorBoard's event files, read back by a reader of their published frame and of protocol buffers that shares no code with the writer.
#include "model/train/tensorboard.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "model/train/run_folder.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::model;
using namespace actformer::test;

namespace {

/// Bit by bit, from the polynomial 0x1EDC6F41 reversed.
std::uint32_t crc32c(const std::string& text) {
    std::uint32_t sum = 0xFFFFFFFF;
    for (const unsigned char c : text) {
        sum ^= c;
        for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum & 1 ? 0x82F63B78 : 0);
    }
    return ~sum;
}

std::uint32_t masked(const std::string& text) {
    const auto sum = crc32c(text);
    return ((sum >> 15) | (sum << 17)) + 0xa282ead8U;
}

template <typename Number>
Number number_at(const std::string& text, std::size_t at) {
    Number number;
    std::memcpy(&number, text.data() + at, sizeof number);
    return number;
}

struct Event {
    double time = 0;
    std::uint64_t step = 0;
    std::string version;
    std::map<std::string, float> scalars;
};

/// Calls use(field, kind, number, text) for each field of a message.
template <typename Use>
void each_field(const std::string& message, Use use) {
    std::size_t at = 0;
    const auto varint = [&] {
        std::uint64_t number = 0;
        for (int shift = 0;; shift += 7) {
            const auto byte = static_cast<unsigned char>(message.at(at++));
            number |= std::uint64_t{byte & 127U} << shift;
            if (byte < 128) return number;
        }
    };
    while (at < message.size()) {
        const auto key = varint();
        std::uint64_t number = 0;
        std::string text;
        if ((key & 7) == 0) {
            number = varint();
        } else {
            const auto size = (key & 7) == 1 ? 8 : (key & 7) == 5 ? 4 : varint();
            ASSERT_LE(at + size, message.size());
            text = message.substr(at, size);
            at += size;
        }
        use(key >> 3, number, text);
    }
}

std::vector<Event> events_in(const std::string& file) {
    std::vector<Event> events;
    for (std::size_t at = 0; at < file.size();) {
        const auto length = number_at<std::uint64_t>(file, at);
        EXPECT_EQ(number_at<std::uint32_t>(file, at + 8), masked(file.substr(at, 8)));
        const auto message = file.substr(at + 12, length);
        EXPECT_EQ(number_at<std::uint32_t>(file, at + 12 + length), masked(message));
        at += length + 16;
        auto& event = events.emplace_back();
        each_field(message, [&](auto field, auto number, const std::string& text) {
            if (field == 1) event.time = number_at<double>(text, 0);
            if (field == 2) event.step = number;
            if (field == 3) event.version = text;
            if (field != 5) return;
            each_field(text, [&](auto, auto, const std::string& value) {
                std::string tag;
                each_field(value, [&](auto part, auto, const std::string& content) {
                    if (part == 1) tag = content;
                    if (part == 2) event.scalars[tag] = number_at<float>(content, 0);
                });
            });
        });
    }
    return events;
}

}  // namespace

TEST(Tensorboard, ChecksumsAreThePublishedOnes) {
    EXPECT_EQ(crc32c("123456789"), 0xE3069283U);
}

TEST(Tensorboard, ALineBecomesScalarsAtItsStep) {
    const auto text = tensorboard_head(1.5) + tensorboard_event({{"epoch", 3},
                                                                 {"step", 300},
                                                                 {"loss", 0.25},
                                                                 {"fid_mean", -2},
                                                                 {"seconds", 9},
                                                                 {"verdict", "best"}},
                                                                2.5);
    const auto events = events_in(text);
    ASSERT_EQ(events.size(), 2U);
    EXPECT_EQ(events[0].version, "brain.Event:2");
    EXPECT_EQ(events[0].time, 1.5);
    EXPECT_EQ(events[1].time, 2.5);
    EXPECT_EQ(events[1].step, 300U);
    EXPECT_EQ(events[1].scalars, (std::map<std::string, float>{{"loss", 0.25F}, {"fid_mean", -2}}));
    EXPECT_EQ(tensorboard_event({{"epoch", 3}, {"step", 300}, {"why", "nothing to draw"}}, 1), "");
    EXPECT_EQ(tensorboard_event({{"loss", 1}}, 1), "");
}

TEST(Tensorboard, TheFileFollowsTheLogAlsoWhereItGoesBack) {
    const TempDir dir;
    const auto file = dir / "run/events.out.tfevents.actformer";
    {
        RunFolder run(dir / "run", true);
        run.rewind_log(0);
        for (int epoch = 1; epoch <= 3; ++epoch)
            run.log({{"epoch", epoch}, {"step", 10 * epoch}, {"loss", epoch}});
    }
    EXPECT_EQ(events_in(read_file(file)).size(), 4U);
    RunFolder again(dir / "run", true);
    again.rewind_log(1);
    again.log({{"epoch", 2}, {"step", 20}, {"loss", 7}});
    const auto events = events_in(read_file(file));
    ASSERT_EQ(events.size(), 3U);
    EXPECT_EQ(events[1].scalars.at("loss"), 1);
    EXPECT_EQ(events[2].scalars.at("loss"), 7);
    EXPECT_EQ(events[2].step, 20U);
    {
        RunFolder plain(dir / "plain");
        plain.rewind_log(0);
    }
    EXPECT_FALSE(std::filesystem::exists(dir / "plain/events.out.tfevents.actformer"));
}
