"""From a URL to a session: opens the link, and waits for an autopilot on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from offboard.errors import InputError, LinkError
from offboard.live.session import MavsdkSession

if TYPE_CHECKING:
    from mavsdk import Mavsdk

    from offboard.live.relay import Relay


def connect(url: str, timeout: float = 30.0, signing_key: bytes | None = None) -> MavsdkSession:
    """Connect to the first autopilot that is heard.

    Parameters
    ----------
    url : str
        As MAVSDK writes it: udpin://0.0.0.0:14540, tcpout://127.0.0.1:5760, serial:///dev/ttyUSB0:57600.
    timeout : float
        How long to wait for a heartbeat [s].
    signing_key : bytes, optional
        With a key of 32 bytes all frames are signed, and those that are not signed with it are dropped.

    Raises
    ------
    InputError
        If the URL is none.
    LinkError
        If it cannot be opened or nothing is heard; says what to look at.
    """
    mavsdk = quiet_mavsdk()
    relay: Relay | None = None
    try:
        if signing_key is None:
            _open(mavsdk, url)
        else:
            relay = _open_signed(mavsdk, url, signing_key)
        system = mavsdk.first_autopilot(timeout)
        if system is not None:
            return MavsdkSession(mavsdk, system, relay)
        raise LinkError(f"no autopilot was heard on {url} within {timeout:g} s{_why(relay)}")
    except BaseException:
        if relay is not None:
            relay.close()
        mavsdk.destroy()
        raise


def _open(mavsdk: Mavsdk, url: str) -> None:
    result = mavsdk.add_any_connection(url)
    if result.name != "SUCCESS":
        kind = InputError if result.name == "CONNECTION_URL_INVALID" else LinkError
        raise kind(
            f"{url} cannot be opened ({result.name}); "
            "such as udpin://0.0.0.0:14540, tcpout://127.0.0.1:5760, serial:///dev/ttyUSB0:57600"
        )


def _open_signed(mavsdk: Mavsdk, url: str, key: bytes) -> Relay:
    from offboard.live.relay import Relay  # noqa: PLC0415

    mavsdk.add_any_connection("raw://")
    relay = Relay(url, key, mavsdk.pass_received_raw_bytes)
    mavsdk.subscribe_raw_bytes_to_be_sent(relay.send)
    return relay


def _why(relay: Relay | None) -> str:
    """Why a signed link may be silent."""
    if relay is None or relay.accepted or not relay.dropped:
        return ""
    return (
        ": what comes is not signed with the key of --signing-key, or the vehicle's clock is more than a "
        "minute behind ours"
    )


def quiet_mavsdk() -> Mavsdk:
    """MAVSDK as a companion computer that does not write to the terminal."""
    from mavsdk import ComponentType, Configuration, Mavsdk  # noqa: PLC0415
    from mavsdk.logging import log_subscribe  # noqa: PLC0415

    log_subscribe(lambda *_: True)
    return Mavsdk(Configuration.create_with_component_type(ComponentType.COMPANION_COMPUTER))
