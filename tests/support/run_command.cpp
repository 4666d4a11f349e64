#include "tests/support/run_command.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace sconce::testing_support
{

namespace
{

/// A message of the validation layer (OwnDevice prints them with this prefix) fails the test whose command caused it.
void expectValid(const std::vector<std::string>& arguments, const std::string& err)
{
    std::istringstream lines(err);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("validation: ")) ADD_FAILURE() << "sconce " << testing::PrintToString(arguments) << "\n" << line;
}

/// Time that all threads of a process have computed for. It doesn't pass while other processes hold the machine.
double processorSeconds(pid_t process)
{
    clockid_t clock = 0;
    timespec time = {};
    if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0.0; // it has just ended
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

} // namespace

CommandResult sconceCommand(const std::vector<std::string>& arguments, const CommandLimits& limits)
{
    const TestFolder folder;
    const std::string outFile = folder / "out", errFile = folder / "err";
    std::vector<char*> argv{const_cast<char*>(SCONCE_COMMAND)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    [[maybe_unused]] static const int validated = setenv("SCONCE_VALIDATION", "1", 1);
    writeText(errFile, ""); // to be read from the first moment on
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child == 0)
    {
        // A test that is ended from outside takes its command with it.
        if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent) _exit(125);
        const int out = open(outFile.c_str(), O_CREAT | O_WRONLY, 0600), err = open(errFile.c_str(), O_WRONLY);
        if (out < 0 || err < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0) _exit(126);
        execv(argv[0], argv.data());
        _exit(127);
    }
    CommandResult result;
    int status = 0;
    bool interrupted = limits.interruptWhen.empty();
    while (waitpid(child, &status, WNOHANG) == 0)
    {
        if (!interrupted && readText(errFile).find(limits.interruptWhen) != std::string::npos)
        {
            interrupted = true;
            kill(child, SIGINT);
        }
        if (processorSeconds(child) >= limits.processorSeconds)
        {
            result.timedOut = true;
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            break;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    if (WIFEXITED(status)) result.exit = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
    result.out = readText(outFile);
    result.err = readText(errFile);
    expectValid(arguments, result.err);
    return result;
}

} // namespace sconce::testing_support
