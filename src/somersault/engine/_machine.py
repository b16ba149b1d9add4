"""LLVM text to machine code of this processor."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any

from somersault._core.stages import stage

_ROUNDING = ("fma", "fma4", "avx2", "avx512f", "neon", "sve")  # as LLVM calls them


def compiled(*modules: str) -> Any:
    """Machine code of LLVM modules, for this processor.

    Parameters
    ----------
    *modules : str
        LLVM assembly; the modules may call one another's functions.

    Returns
    -------
    llvmlite.binding.ExecutionEngine
        `compiled_function` takes a function from it.
    """
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_default_triple()
    machine = target.create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=2,
        jit=True,
    )
    with stage("compiling"):
        whole, *others = [llvm.parse_assembly(text) for text in modules]
        for other in others:
            whole.link_in(other)
        engine = llvm.create_mcjit_compiler(whole, machine)
        engine.finalize_object()
    return engine


def compiled_function(engine: Any, name: str, *arguments: Any) -> Callable[..., None]:
    """A compiled function that can be called; it returns nothing.

    It keeps its engine, and so its code, as long as it lives.

    Parameters
    ----------
    engine : llvmlite.binding.ExecutionEngine
        As `compiled` returns it.
    name : str
        Of the function in its module.
    *arguments : ctypes type
        Of the function's arguments.

    Returns
    -------
    callable
    """
    pointer = ctypes.CFUNCTYPE(None, *arguments)(engine.get_function_address(name))
    pointer.engine = engine  # type: ignore[attr-defined]
    return pointer


@cache
def processor() -> str:
    """The kind of processor that code is compiled for here.

    Returns
    -------
    str
        LLVM's name of it, and what decides how it rounds: which multiply-adds are fused, and how
        wide its vectors are.
    """
    import llvmlite.binding as llvm

    features = llvm.get_host_cpu_features()
    return "+".join([llvm.get_host_cpu_name(), *(f for f in _ROUNDING if features.get(f))])
