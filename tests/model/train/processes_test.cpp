// Processes that train together, here threads that meet as processes do.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <future>

#include "model/train/processes.hpp"

namespace actformer::model {
namespace {

Place place_of_two(int rank) {
    Place place;
    place.rank = place.local = rank;
    place.size = 2;
    place.address = "127.0.0.1";
    place.port = static_cast<std::uint16_t>(20000 + (::getpid() + 7) % 20000);
    place.prefix = "processes_test";
    return place;
}

/// What rank 1 is told: of its own tensor after a mean of both, and of the one that follows when rank 0 has ended.
std::string second_of_two() {
    const Processes here(place_of_two(1), at::kCPU);
    auto value = at::full({3}, 4.0F);
    here.all_reduce_mean(value);
    EXPECT_TRUE(value.equal(at::full({3}, 3.0F)));
    try {
        here.all_reduce_mean(value);
    } catch (const PeerLost& e) {
        return e.what();
    }
    return "nothing";
}

TEST(Processes, OneThatEndsIsMissedByTheOtherInALine) {
    try {
        auto second = std::async(std::launch::async, second_of_two);
        {
            const Processes here(place_of_two(0), at::kCPU);
            auto value = at::full({3}, 2.0F);
            here.all_reduce_mean(value);
            EXPECT_TRUE(value.equal(at::full({3}, 3.0F)));
        }
        EXPECT_EQ(second.get(),
                  "rank 1 of 2: another process has ended or cannot be reached; that one says why");
    } catch (const Error& e) {
        if (std::string(e.what()).find("no Gloo") == std::string::npos) throw;
        GTEST_SKIP() << e.what();
    }
}

/// A socket that listens, and its port.
struct Listener {
    Listener() : socket(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        socklen_t size = sizeof(address);
        auto* any = reinterpret_cast<sockaddr*>(&address);
        EXPECT_EQ(::bind(socket, any, size), 0);
        EXPECT_EQ(::listen(socket, 1), 0);
        EXPECT_EQ(::getsockname(socket, any, &size), 0);
        port = ntohs(address.sin_port);
    }
    ~Listener() { ::close(socket); }
    int socket;
    std::uint16_t port = 0;
};

TEST(Processes, SayInALineWhereTheyCannotMeet) {
    const Listener other;
    auto place = place_of_two(0);
    place.port = other.port;
    try {
        const Processes here(place, at::kCPU);
        FAIL() << "another program listens at that port";
    } catch (const Error& e) {
        const std::string said = e.what();
        if (said.starts_with("--data-parallel")) GTEST_SKIP() << said;
        EXPECT_TRUE(said.starts_with(fmt::format("rank 0 of 2: no meeting at 127.0.0.1:{}: ", other.port)))
            << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
}

}  // namespace
}  // namespace actformer::model
