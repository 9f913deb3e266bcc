"""A headless Chromium as the report's test uses it: Selenium's driver, and the gestures that it has no short word for."""

import base64
import shutil
import tempfile

try:
    from selenium import webdriver
    from selenium.common.exceptions import TimeoutException
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.common.print_page_options import PrintOptions
    from selenium.webdriver.support.wait import WebDriverWait
except ImportError:
    webdriver = None


def available():
    """Whether Selenium, chromedriver and a Chromium for it to drive are installed."""
    return bool(webdriver and shutil.which("chromedriver") and shutil.which("chromium"))


class Browser:
    """Used in a with statement, which ends driver, browser and profile whatever happens."""

    def __init__(self, width=1280, height=1000):
        self._profile = tempfile.TemporaryDirectory(prefix="actformer-browser-", ignore_cleanup_errors=True)
        options = webdriver.ChromeOptions()
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
                         "--disable-background-networking", "--disable-component-update", "--disable-sync",
                         f"--user-data-dir={self._profile.name}", f"--window-size={width},{height}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        try:
            self._driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
        except BaseException:
            self._profile.cleanup()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._driver.quit()
        finally:
            self._profile.cleanup()

    def open(self, url):
        self._driver.get(url)

    def run(self, script, *arguments):
        """The value that `script`, the body of a function, returns."""
        return self._driver.execute_script(script, *arguments)

    def wait(self, script, *arguments, seconds=10):
        """Waits until `script` returns something true and gives that; None when it never did."""
        try:
            return WebDriverWait(self._driver, seconds, poll_frequency=0.05).until(
                lambda _: self.run(script, *arguments))
        except TimeoutException:
            return None

    def find(self, selector):
        return self._driver.find_element(By.CSS_SELECTOR, selector)

    def click(self, selector):
        self.find(selector).click()

    def press(self, *keys, held=None):
        """Presses characters or named keys ("tab", "left"), one after the other, `held` down all the while."""
        value = lambda key: key if len(key) == 1 else getattr(Keys, key.upper())
        chain = ActionChains(self._driver, duration=0)
        if held:
            chain.key_down(value(held))
        for key in keys:
            chain.send_keys(value(key))
        if held:
            chain.key_up(value(held))
        chain.perform()

    def drag(self, selector, dx, dy):
        """Drags from the middle of an element."""
        ActionChains(self._driver, duration=100).drag_and_drop_by_offset(self.find(selector), dx, dy).perform()

    def resize(self, width, height):
        """Gives the page a viewport of exactly this size, below the least width of a window too."""
        self.command("Emulation.setDeviceMetricsOverride",
                     {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def command(self, name, parameters):
        """A command of the Chrome DevTools protocol."""
        return self._driver.execute_cdp_cmd(name, parameters)

    def log(self, kind):
        """Entries of the "browser" or "performance" log since it was last asked for."""
        return self._driver.get_log(kind)

    def whole_page(self):
        """A PNG of the page from top to bottom."""
        # From the top: what is sticky belongs there. With the scroll bar's width: the picture has none.
        width, height = self.run("scrollTo(0, 0); return [innerWidth, document.documentElement.scrollHeight]")
        shot = self.command("Page.captureScreenshot", {
            "captureBeyondViewport": True, "clip": {"x": 0, "y": 0, "width": width, "height": height, "scale": 1}})
        return base64.b64decode(shot["data"])

    def print_pdf(self):
        options = PrintOptions()
        options.background = True
        return base64.b64decode(self._driver.print_page(options))
