#include "tenon/tests/browser.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

namespace tenon {

using nlohmann::json;

namespace {

constexpr int kPatience = 60'000;  // ms, for one answer
constexpr int kFirstPipe = 3;      // the descriptors that the browser reads from and, the next, writes to

}  // namespace

std::string browser_path() {
  for (const char* path : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"}) {
    if (std::filesystem::exists(path)) return path;
  }
  return "";
}

Browser::Browser() {
  int down[2], up[2];
  if (pipe(down) != 0 || pipe(up) != 0) throw std::runtime_error("no pipe to the browser");
  process_ = fork();
  if (process_ == 0) {
    setpgid(0, 0);
    // Out of the way first: one of them may be 3 or 4 itself.
    const int in = fcntl(down[0], F_DUPFD, 10), out = fcntl(up[1], F_DUPFD, 10), nothing = ::open("/dev/null", O_RDWR);
    dup2(in, kFirstPipe);
    dup2(out, kFirstPipe + 1);
    for (const int standard : {0, 1, 2}) dup2(nothing, standard);
    const std::string path = browser_path(), profile = "--user-data-dir=" + profile_.path("");
    execl(path.c_str(), path.c_str(), "--headless", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader",
          "--enable-unsafe-swiftshader", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
          "--remote-debugging-pipe", profile.c_str(), "about:blank", nullptr);
    _exit(127);
  }
  close(down[0]);
  close(up[1]);
  to_browser_ = down[1];
  from_browser_ = up[0];
  fcntl(to_browser_, F_SETFD, FD_CLOEXEC);
  fcntl(from_browser_, F_SETFD, FD_CLOEXEC);
  signal(SIGPIPE, SIG_IGN);  // a browser that has died shows as a failed call
}

Browser::~Browser() {
  close(to_browser_);
  close(from_browser_);
  if (process_ <= 0) return;
  kill(-process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

json Browser::receive() {
  for (;;) {
    const std::size_t end = received_.find('\0');
    if (end != std::string::npos) {
      const json message = json::parse(received_.substr(0, end));
      received_.erase(0, end + 1);
      return message;
    }
    pollfd ready{from_browser_, POLLIN, 0};
    char block[1 << 16];
    const ssize_t count = poll(&ready, 1, kPatience) == 1 ? read(from_browser_, block, sizeof block) : 0;
    if (count <= 0) throw std::runtime_error("the browser does not answer");
    received_.append(block, static_cast<std::size_t>(count));
  }
}

void Browser::note(const json& event) {
  const std::string method = event.value("method", "");
  if (!method.empty() && event.value("sessionId", "") != session_) return;
  const json& parameters = event["params"];
  if (method == "Runtime.exceptionThrown") complaints_.push_back(parameters.dump());
  if (method == "Runtime.consoleAPICalled" && (parameters["type"] == "error" || parameters["type"] == "warning")) complaints_.push_back(parameters["args"].dump());
  if (method == "Log.entryAdded") complaints_.push_back(parameters["entry"].dump());
  if (method == "Network.requestWillBeSent") requests_.push_back(parameters["request"]["url"]);
}

json Browser::call(const std::string& method, const json& parameters) {
  json message{{"id", ++last_id_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump() + '\0';
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(to_browser_, text.data() + done, text.size() - done);
    if (count <= 0) throw std::runtime_error("the browser takes no calls");
    done += static_cast<std::size_t>(count);
  }
  for (;;) {
    json answer = receive();
    if (answer.value("id", 0) != last_id_) {
      note(answer);
      continue;
    }
    if (answer.contains("error")) throw std::runtime_error(method + ": " + answer["error"].dump());
    return answer["result"];
  }
}

json Browser::evaluate(const std::string& expression) {
  const json answer = call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (answer.contains("exceptionDetails")) throw std::runtime_error(expression + ": " + answer["exceptionDetails"].dump());
  return answer["result"].value("value", json());
}

bool Browser::wait_for(const std::string& condition) {
  for (int k = 0; k < 400; ++k) {
    if (evaluate("Boolean(" + condition + ")") == true) return true;
    usleep(50'000);
  }
  return false;
}

void Browser::open(const std::string& file, const std::string& condition, int width, int height) {
  session_.clear();
  if (!target_.empty()) call("Target.closeTarget", {{"targetId", target_}});
  target_ = call("Target.createTarget", {{"url", "about:blank"}})["targetId"];
  session_ = call("Target.attachToTarget", {{"targetId", target_}, {"flatten", true}})["sessionId"];
  complaints_.clear();
  requests_.clear();
  for (const char* domain : {"Page", "Runtime", "Log", "Network"}) call(std::string(domain) + ".enable", json::object());
  call("Emulation.setDeviceMetricsOverride", {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", width < 600}});
  call("Page.navigate", {{"url", "file://" + file}});
  if (!wait_for(condition)) throw std::runtime_error(file + ": waited in vain for " + condition);
}

}  // namespace tenon
