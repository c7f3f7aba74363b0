// A real browser without a window, driven over the WebDriver protocol (chromedriver).
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "background_program.h"
#include "temporary_folder.h"

/// Encodes bytes for a script's argument.
std::string to_base64(const std::string& bytes);

class Browser {
 public:
  /// Starts chromedriver and Chromium. Throws std::runtime_error, which names the packages if they are
  /// missing.
  Browser(int width, int height);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& url) { command("POST", "/url", {{"url", url}}); }
  void reload() { command("POST", "/refresh", nlohmann::json::object()); }
  void resize(int width, int height);
  /// Runs the body of an async function in the page and returns its value. Throws std::runtime_error for what
  /// the script throws.
  nlohmann::json run(const std::string& script, const nlohmann::json& arguments = nlohmann::json::array());
  /// Waits until the script returns true. Throws std::runtime_error after `seconds`.
  void wait_until(const std::string& script, double seconds = 120);
  /// Moves the mouse over the page, in page pixels: down at the first point, up at the last. One point is a
  /// click.
  void drag(const std::vector<std::pair<int, int>>& points, const std::string& modifier = "");
  void double_click(int x, int y);
  /// Moves several fingers at once, each along its points: down at the first, up at the last. All have
  /// equally many points.
  void touch(const std::vector<std::vector<std::pair<int, int>>>& fingers);
  /// The colour scheme that the browser reports as its user's preference.
  void prefer_dark(bool dark);
  /// Presses keys together in the focused element; "\uE00C" and the like are WebDriver's special keys.
  void keys(const std::vector<std::string>& keys);
  /// Types one character after the other into the focused element, `gap` milliseconds apart.
  void type(const std::string& text, int gap);
  /// Opens a URL in a new tab and switches to it. Tabs count from 0.
  void open_tab(const std::string& url);
  void use_tab(std::size_t index);
  std::size_t tabs();
  /// The visible page as PNG.
  std::string screenshot();
  /// Errors that the page has logged so far.
  std::vector<std::string> errors();
  /// The folder of downloads.
  const TemporaryFolder& downloads() const { return downloads_; }

 private:
  nlohmann::json command(const std::string& method, const std::string& path,
                         const nlohmann::json& body = nullptr);
  void perform(const nlohmann::json& actions);

  TemporaryFolder profile_, downloads_;
  BackgroundProgram driver_;
  int port_ = 0;
  std::string session_;
};
