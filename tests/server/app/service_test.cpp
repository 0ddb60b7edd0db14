// heliographd as its user runs it: starts, serves, is killed, comes back, stops in order.
#include "server/store/blob_store.h"
#include "tests/support/places.h"
#include "tests/support/raw_http.h"
#include "tests/support/run_program.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <fcntl.h>
#include <optional>
#include <spawn.h>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace {

using test_support::fetch;
using test_support::HttpAnswer;
using Json = nlohmann::json;

const std::string kProgram = tests::bin_dir() + "/heliographd";

// One process of the service, killed with this object if it still runs.
class Service {
public:
    Service(const tests::TempFolder& folder, std::vector<std::string> options = {})
    {
        options.insert(options.begin(), {kProgram, "--port", "0", "--data", folder.file("data")});
        int ends[2] = {};
        if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe2");
        const std::string log = folder.file("log");
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        posix_spawn_file_actions_addopen(
            &actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
        std::vector<char*> words;
        for (std::string& word : options)
            words.push_back(word.data());
        words.push_back(nullptr);
        const int error = posix_spawn(&pid_, kProgram.c_str(), &actions, nullptr, words.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
        if (error != 0) throw std::system_error(error, std::generic_category(), kProgram);
        read_ready_line(ends[0]);
        close(ends[0]);
    }
    ~Service()
    {
        if (pid_ == 0) return;
        send(SIGKILL);
        wait();
    }
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;

    void send(int signal) const { kill(pid_, signal); }
    int wait() // the exit code, 128 + signal
    {
        int status = 0;
        while (waitpid(pid_, &status, 0) < 0)
            if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
        pid_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    int port() const { return port_; }
    int health_port() const { return health_port_; }
    const std::string& line() const { return line_; }

private:
    void read_ready_line(int out)
    {
        char byte = 0;
        while (read(out, &byte, 1) == 1 && byte != '\n')
            line_ += byte;
        if (std::sscanf(line_.c_str(),
                        "heliographd ready on http://127.0.0.1:%d (health http://127.0.0.1:%d)",
                        &port_,
                        &health_port_) != 2)
            throw std::runtime_error("not ready: " + line_);
    }

    pid_t pid_ = 0;
    int port_ = 0, health_port_ = 0;
    std::string line_;
};

std::string job(int samples, int side = 32)
{
    return R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":)" + std::to_string(side) +
           R"(,"height":)" + std::to_string(side) + R"(},"quality":{"samples":)" + std::to_string(samples) +
           "}}";
}

const test_support::Headers kJson{{"Content-Type", "application/json"}};

std::string id_of(const HttpAnswer& answer)
{
    return Json::parse(answer.body).at("id").get<std::string>();
}

// Waits for the job's end; its picture.
std::string picture_of(const Service& service, const std::string& id)
{
    const std::string path = "/v1/jobs/" + id;
    for (int i = 0; i < 10; ++i) {
        const HttpAnswer seen = fetch(service.port(), "GET", path, {{"Prefer", "wait=20"}});
        const auto state = Json::parse(seen.body).at("state").get<std::string>();
        if (state == "succeeded") break;
        if (state == "failed" || state == "canceled") throw std::runtime_error(seen.body);
    }
    const HttpAnswer image = fetch(service.port(), "GET", path + "/image");
    EXPECT_EQ(image.status, 200) << image.body;
    return image.body;
}

TEST(Heliographd, ServesAndStopsWhenAsked)
{
    const tests::TempFolder folder;
    for (const int signal : {SIGTERM, SIGINT}) {
        Service service(folder);
        EXPECT_EQ(fetch(service.port(), "GET", "/readyz").status, 200);
        EXPECT_EQ(fetch(service.health_port(), "GET", "/healthz").status, 200);
        const HttpAnswer accepted = fetch(service.port(), "POST", "/v1/jobs", kJson, job(4));
        EXPECT_EQ(accepted.status, 202) << accepted.body;
        EXPECT_EQ(picture_of(service, id_of(accepted)).substr(1, 3), "PNG");
        service.send(signal);
        EXPECT_EQ(service.wait(), 0);
    }
}

TEST(Heliographd, KeepsEveryAcceptedJobThroughKills)
{
    const tests::TempFolder folder;
    std::vector<std::string> ids;
    for (int life = 0; life < 4; ++life) {
        Service service(folder);
        for (int i = 0; i < 5; ++i) {
            const HttpAnswer accepted =
                fetch(service.port(), "POST", "/v1/jobs", kJson, job(1 + i + 5 * life, 64));
            ASSERT_EQ(accepted.status, 202) << accepted.body;
            ids.push_back(id_of(accepted));
        }
        service.send(SIGKILL); // somewhere between queue and disk
        EXPECT_EQ(service.wait(), 128 + SIGKILL);
    }
    const tests::TempFolder calm_folder;
    Service service(folder), calm(calm_folder);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const HttpAnswer undisturbed =
            fetch(calm.port(), "POST", "/v1/jobs", kJson, job(static_cast<int>(1 + i), 64));
        EXPECT_EQ(server::digest_of(picture_of(service, ids[i])),
                  server::digest_of(picture_of(calm, id_of(undisturbed))));
    }
}

TEST(Heliographd, GivesARunningJobBackWhenItStops)
{
    const tests::TempFolder folder;
    std::string id;
    {
        Service service(folder);
        id = id_of(fetch(service.port(), "POST", "/v1/jobs", kJson, job(65536, 1024)));
        service.send(SIGTERM);
        EXPECT_EQ(service.wait(), 0);
    }
    const Service service(folder);
    const HttpAnswer seen = fetch(service.port(), "GET", "/v1/jobs/" + id);
    EXPECT_EQ(seen.status, 200);
    EXPECT_EQ(fetch(service.port(), "DELETE", "/v1/jobs/" + id).status, 204);
}

TEST(Heliographd, LetsNoSecondServiceIntoItsFolder)
{
    const tests::TempFolder folder;
    const Service service(folder);
    const tests::ProgramRun second =
        tests::run_program({kProgram, "--port", "0", "--data", folder.file("data")});
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_NE(second.err.find(folder.file("data")), std::string::npos) << second.err;
    EXPECT_EQ(second.out, "");
}

TEST(Heliographd, SaysWhyItCannotStart)
{
    const tests::TempFolder folder;
    const Service service(folder);
    const tests::ProgramRun taken = tests::run_program({kProgram,
                                                        "--port",
                                                        std::to_string(service.port()),
                                                        "--health-port",
                                                        "0",
                                                        "--data",
                                                        folder.file("other")});
    EXPECT_EQ(taken.exit_code, 1);
    EXPECT_NE(taken.err.find(std::to_string(service.port())), std::string::npos) << taken.err;

    const tests::ProgramRun no_importer = tests::run_program(
        {kProgram, "--port", "0", "--data", folder.file("third"), "--import-program", "/no/such"});
    EXPECT_EQ(no_importer.exit_code, 1);
    EXPECT_NE(no_importer.err.find("--import-program"), std::string::npos) << no_importer.err;

    const tests::ProgramRun wrong = tests::run_program({kProgram, "--port", "http"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_NE(wrong.err.find("--port"), std::string::npos);
}

TEST(Heliographd, TellsItsVersion)
{
    const tests::ProgramRun run = tests::run_program({kProgram, "--version"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.out.rfind("heliographd ", 0), 0U) << run.out;
    EXPECT_NE(run.out.find("commit"), std::string::npos);
}

} // namespace
