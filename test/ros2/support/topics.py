# SPDX-License-Identifier: Apache-2.0
"""Topics and services as a test wants them, as in test/ros/support/topics.py: the values that came, the value that comes, a
message that surely arrives."""
import pydoc
import threading
import time

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from support.patience import PATIENCE, once_more, stay_quiet, wait_until
from support.ros import polled, spun

STEP = 0.005  # seconds from a look to the next


def qos(depth=1000, latched=False, best_effort=False):
    return QoSProfile(
        depth=depth,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        reliability=ReliabilityPolicy.BEST_EFFORT if best_effort else ReliabilityPolicy.RELIABLE)


class Subscription:
    """The messages of a topic, from the moment of the subscription on."""

    def __init__(self, name, kind, profile=None):
        if profile is None:  # what says how a device is comes to late subscribers, too
            profile = qos(latched=name.endswith(("/online", "/status")))
        self._kind = kind
        self._handle = polled.create_subscription(
            kind, name, lambda _: None, profile,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False))

    def take(self):
        """What has come since the last call."""
        messages = []
        handle = self._handle.handle
        with handle:
            while taken := handle.take_message(self._kind, False):
                messages.append(taken[0])
        return messages

    def wait_for(self, condition, seconds=PATIENCE):
        """The first message from now on for which condition(message) is true."""
        end = time.monotonic() + seconds
        last = None
        while True:
            is_over = time.monotonic() > end
            for last in self.take():
                if condition(last):
                    return last
            if is_over:
                raise AssertionError(f"{self._handle.topic_name}: waited {seconds} s; the last message was {last}")
            time.sleep(STEP)

    @property
    def publishers(self):
        return self._handle.get_publisher_count()

    def close(self):
        if self._handle:
            polled.destroy_subscription(self._handle)
            self._handle = None


def content(message):
    """Its data; of a message without, the message."""
    return getattr(message, "data", message)


class Topic:
    """What was published on a topic: `values` since the subscription or since a test has cleared them, `ever` all of it."""

    def __init__(self, name, kind, latched=False, profile=None):
        self.name, self._kind = name, kind
        self._profile = profile or (qos(latched=True) if latched else None)
        self._ever = []
        self._subscribe()

    def _subscribe(self):
        self._values = []
        self._subscription = Subscription(self.name, self._kind, self._profile)

    def _take(self):
        for message in self._subscription.take() if self._subscription else ():
            self._values.append(content(message))
            self._ever.append(content(message))

    @property
    def values(self):
        self._take()
        return self._values

    @property
    def ever(self):
        self._take()
        return self._ever

    @property
    def publishers(self):
        return self._subscription.publishers

    def wait_for(self, condition, seconds=PATIENCE):
        """The first value, of those that came and those that come, for which condition(value) is true."""
        end = time.monotonic() + seconds
        at = 0
        while True:
            is_over = time.monotonic() > end
            values = self.values
            for value in values[at:]:
                if condition(value):
                    return value
            at = len(values)
            if is_over:
                raise AssertionError(f"{self.name}: waited {seconds} s; the last values were {values[-5:]}")
            time.sleep(STEP)

    def becomes(self, value):
        """Until the last value is this one, whatever came before."""
        self.wait_for(lambda _: self.values[-1] == value)

    def next(self):
        """The next value that comes."""
        self.values.clear()
        return self.wait_for(lambda _: True)

    def stays_quiet(self):
        """Nothing is published from now on."""
        stay_quiet([self])

    def subscribe_anew(self):
        """What was published before may still be under way in the old subscription."""
        self.close()
        self._subscribe()

    def close(self):
        if self._subscription:
            self._take()
            self._subscription.close()
            self._subscription = None


class Latest:
    """The last message of a topic, and a wait for one that fits."""

    def __init__(self, name, kind, merge):
        self._merge = merge
        self._known = {}
        self._subscription = Subscription(name, kind)

    @property
    def known(self):
        for message in self._subscription.take():
            self._merge(self._known, message)
        return self._known

    def wait_for(self, condition, seconds=PATIENCE):
        try:
            wait_until(lambda: condition(self.known), "", seconds)
        except AssertionError as error:
            raise AssertionError(f"waited {seconds} s; last: {self._known}") from error
        return dict(self._known)

    def close(self):
        self._subscription.close()


class Publisher:
    """Takes a message, or what its `data` is to be."""

    def __init__(self, name, kind, profile=None, events=None):
        self.name, self.data_class = name, kind
        fields = getattr(kind, "get_fields_and_field_types")()
        self._is_real = any(word in fields.get("data", "") for word in ("float", "double"))
        self._handle = spun.create_publisher(
            kind, name, profile or qos(100), event_callbacks=events or PublisherEventCallbacks(use_default_callbacks=False))

    @property
    def subscribers(self):
        return self._handle.get_subscription_count()

    def publish(self, value=None, data=None):
        if isinstance(value, self.data_class):
            return self._handle.publish(value)
        value = data if value is None else value
        if self._is_real:  # rclpy takes no whole number for one
            value = [float(one) for one in value] if isinstance(value, (list, tuple)) else float(value)
        return self._handle.publish(self.data_class(data=value))

    def unregister(self):
        if self._handle:
            spun.destroy_publisher(self._handle)
            self._handle = None


def connected_publishers(kinds):
    """A publisher for each topic of {name: type}, once somebody listens to all of them."""
    publishers = [Publisher(name, kind) for name, kind in kinds.items()]
    return [_connected(publisher) for publisher in publishers]


def _connected(publisher):
    """On a busy machine Fast DDS may never match two ends that came at the same moment; a new end is matched then."""
    try:
        wait_until(lambda: publisher.subscribers > 0, "", PATIENCE / 6)
    except AssertionError:
        publisher.unregister()
        publisher = Publisher(publisher.name, publisher.data_class)
        wait_until(lambda: publisher.subscribers > 0, f"a subscriber of {publisher.name}")
    return publisher


def next_message(name, kind):
    subscription = Subscription(name, kind)
    try:
        return subscription.wait_for(lambda _: True)
    finally:
        subscription.close()


def types():
    """{topic: [type]} of the graph."""
    return dict(polled.get_topic_names_and_types())


def type_of(name):
    """Of a topic; None until somebody publishes or subscribes."""
    known = types().get(name)
    return pydoc.locate(known[0].replace("/", ".")) if known else None


class NoService(Exception):
    pass


_clients = {}  # {(name, type): client}; one that stays finds the next server, too


def service(name, kind, seconds=PATIENCE):
    """A function that calls it, once it is there."""
    client = _clients.setdefault((name, kind), None) or spun.create_client(kind, name)
    _clients[name, kind] = client
    if not client.wait_for_service(seconds):
        raise NoService(name)
    fields = list(kind.Request.get_fields_and_field_types())

    def call(*arguments):
        def attempt():
            done = threading.Event()
            future = client.call_async(kind.Request(**dict(zip(fields, arguments))))
            future.add_done_callback(lambda _: done.set())
            if done.wait(PATIENCE / 2):
                return future.result()
            client.remove_pending_request(future)
            raise AssertionError(f"{name} has not answered in {PATIENCE / 2} s: {arguments}")

        # Fast DDS drops an answer if the service's end has not matched the client yet, though the client's end has.
        return once_more(attempt)

    return call


def response_of(kind):
    """The message that a service of this type answers with."""
    return kind.Response
