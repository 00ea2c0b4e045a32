"""Text files of instruments, spreadsheets and editors, which say nowhere how their letters are encoded."""


def decoded(content: bytes) -> str:
    """The text of a file: UTF-8 or UTF-16, with byte order mark or without, else Windows-1252.

    What the encoding does not have is a replacement character.

    Examples
    --------
    >>> decoded("µm".encode("utf-16-le")), decoded("µm".encode("cp1252"))
    ('µm', 'µm')
    """
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return content.decode("utf-16", "replace")
    # Without a mark, every other byte of the first letters is zero.
    low, high = content[1:4:2] == b"\0\0", content[0:3:2] == b"\0\0"
    if low or high:
        return content.decode("utf-16-le" if low else "utf-16-be", "replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        # Text of Windows may have any byte.
        return content.decode("cp1252", "replace")
