"""A drive through the bridge of Foxglove's SDK. Its recording is read by Foxglove's mcap package and by rosbags."""
import pathlib
import subprocess
import threading
import time
import unittest

import foxglove
from mcap.reader import NonSeekingReader

import recording
import sample

TIMEOUT = 60  # s


class Subscriptions(foxglove.ServerListener):
    """Waits until a client has subscribed to all topics."""

    def __init__(self, topics: set[str]) -> None:
        self.missing = set(topics)
        self.complete = threading.Event()

    def on_subscribe(self, client: object, channel: foxglove.websocket.ChannelView) -> None:
        self.missing.discard(channel.topic)
        if not self.missing:
            self.complete.set()


class Bridge:
    """Sends messages of ROS 2 to one client."""

    def __init__(self, messages: list[recording.Recorded]) -> None:
        self.messages = messages
        types = {recorded.topic: recorded.type for recorded in messages}
        self.context = foxglove.Context()
        self.channels = {topic: self.channel(topic, type_name) for topic, type_name in types.items()}
        self.subscriptions = Subscriptions(set(types))
        self.server = foxglove.start_server(port=0, context=self.context, server_listener=self.subscriptions,
                                            message_backlog_size=2 * len(messages))

    def channel(self, topic: str, type_name: str) -> foxglove.Channel:
        definition, _ = recording.ROS2.generate_msgdef(type_name)
        schema = foxglove.Schema(name=type_name, encoding="ros2msg", data=definition.encode())
        return foxglove.Channel(topic, schema=schema, message_encoding="cdr", context=self.context)

    def play(self) -> int:
        """Sends all messages. Returns their bytes."""
        if not self.subscriptions.complete.wait(TIMEOUT):
            raise AssertionError(f"no client subscribes to {self.subscriptions.missing}")
        size = 0
        for recorded in self.messages:
            data = bytes(recording.ROS2.serialize_cdr(recorded.message, recorded.type))
            self.channels[recorded.topic].log(data, log_time=recorded.time)
            size += len(data)
        return size


def wait_for_size(path: pathlib.Path, size: int) -> None:
    """The server drops what it has not sent when it stops."""
    deadline = time.monotonic() + TIMEOUT
    while not path.exists() or path.stat().st_size < size:
        if time.monotonic() > deadline:
            raise AssertionError(f"{path.name} is not complete after {TIMEOUT} s")
        time.sleep(0.05)


class BridgeTest(unittest.TestCase):
    def convert(self, messages: list[recording.Recorded]) -> pathlib.Path:
        """The drive that `fovea convert` makes of the messages."""
        drive = sample.folder() / "live" / "drive"
        drive.parent.mkdir()
        bridge = Bridge(messages)
        command = [sample.PROGRAM, "convert", f"ws://127.0.0.1:{bridge.server.port}", "-o", str(drive), "--quiet",
                   "--reconnect", "0"]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as program:
            try:
                wait_for_size(pathlib.Path(f"{drive}.mcap"), bridge.play())
                bridge.server.stop()
                _, errors = program.communicate(timeout=TIMEOUT)
            finally:
                program.kill()
        self.assertEqual(program.returncode, 0, errors)
        return drive

    def test_convert(self):
        messages = recording.Vehicle(sample.recorded_drive(), recording.ROS2).messages()
        drive = self.convert(messages)
        self.assertEqual(sample.digest(drive), sample.digest(sample.recorded_drive()))
        with open(f"{drive}.mcap", "rb") as file:
            recorded = list(NonSeekingReader(file).iter_messages(log_time_order=False))
        self.assertEqual([channel.topic for _, channel, _ in recorded], [message.topic for message in messages])
        # rosbags reads the messages themselves.
        for (_, channel, message), sent in zip(recorded, messages):
            with self.subTest(topic=channel.topic):
                read = recording.ROS2.deserialize_cdr(message.data, sent.type)
                self.assertEqual(recording.ROS2.serialize_cdr(read, sent.type),
                                 recording.ROS2.serialize_cdr(sent.message, sent.type))


if __name__ == "__main__":
    unittest.main()
