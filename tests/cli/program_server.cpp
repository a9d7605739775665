// Preloaded into the program (LD_PRELOAD), this makes a server of it: it is loaded once, and each request is a fork of
// it that calls `main`. To load it takes 0.1 s of a processor, as GDAL needs a hundred libraries, and the tests of the
// command line call it thousands of times. tests/cli/support.py asks.
#include <dlfcn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

using Main = int (*)(int, char**, char**);
using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);

Main program_main = nullptr;

/// One call of the program.
struct Request {
  std::vector<std::string> words;  ///< the folder, then the arguments
  std::array<int, 2> streams{};    ///< stdout, stderr
};

/// @return false if nobody asks any more
bool receive(int socket, Request& request) {
  std::string text(std::size_t{1} << 20, '\0');
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof request.streams)> control{};
  iovec part{text.data(), text.size()};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t length = recvmsg(socket, &message, 0);
  if (length <= 0 || CMSG_FIRSTHDR(&message) == nullptr) return false;
  std::memcpy(request.streams.data(), CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof request.streams);
  text.resize(static_cast<std::size_t>(length));
  request.words.clear();
  for (std::size_t first = 0; first < text.size();) {
    const std::size_t end = text.find('\0', first);
    request.words.push_back(text.substr(first, end - first));
    first = end + 1;
  }
  return true;
}

/// In the fork: the program, as if it had been started.
int run(const Request& request, char* name, char** environment) {
  for (int i : {0, 1}) {
    dup2(request.streams[static_cast<std::size_t>(i)], i + 1);
    close(request.streams[static_cast<std::size_t>(i)]);
  }
  if (chdir(request.words[0].c_str()) != 0) return 127;
  static std::vector<std::string> words;  // as long as the program runs
  words = request.words;
  std::vector<char*> arguments{name};
  for (std::size_t i = 1; i < words.size(); ++i) arguments.push_back(words[i].data());
  arguments.push_back(nullptr);
  return program_main(static_cast<int>(words.size()), arguments.data(), environment);
}

int serve(int, char** arguments, char** environment) {
  const int socket = std::atoi(std::getenv("TALUS_SERVER"));
  unsetenv("TALUS_SERVER");
  unsetenv("LD_PRELOAD");
  for (Request request; receive(socket, request);) {
    const pid_t child = fork();
    if (child < 0) return 1;
    if (child == 0) {
      close(socket);
      return run(request, arguments[0], environment);
    }
    for (const int stream : request.streams) close(stream);
    int status = 0;
    if (send(socket, &child, sizeof child, 0) < 0 || waitpid(child, &status, 0) < 0 ||
        send(socket, &status, sizeof status, 0) < 0)
      return 1;
  }
  return 0;
}

}  // namespace

/// Start of the program in the C library, which calls `main`.
extern "C" int __libc_start_main(Main main, int count, char** arguments, void (*init)(), void (*fini)(),
                                 void (*rtld_fini)(), void* stack_end) {
  program_main = main;
  const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(serve, count, arguments, init, fini, rtld_fini, stack_end);
}
