//! `#[derive(PhysicsLayer)]`: an enum without fields becomes a set of collision layers, one bit per
//! variant.

use proc_macro_crate::{FoundCrate, crate_name};
use proc_macro2::{Span, TokenStream};
use quote::quote;
use syn::{Data, DeriveInput, Error, Fields, Ident, Variant, parse_macro_input};

/// How many layers a mask has room for.
const MAX_LAYERS: usize = 32;

/// Implements `PhysicsLayer` for an enum without fields.
///
/// The variant marked `#[default]` (the attribute of `#[derive(Default)]`, which the trait needs as well) is bit 0, at
/// any place in the enum: the layer of colliders without a choice. The others are bits 1, 2, … in order. There may be
/// at most 32 variants.
///
/// The trait is taken from `avian2d` or `avian3d`, whichever the manifest depends on, under any name. With both or
/// neither (a crate that re-exports the engine), the trait `PhysicsLayer` in scope is implemented.
#[proc_macro_derive(PhysicsLayer, attributes(default))]
pub fn derive_physics_layer(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    expand(&input, &trait_path()).unwrap_or_else(Error::into_compile_error).into()
}

/// The path of the trait as the user's crate sees it.
///
/// A crate may depend on both dimensions optionally, and a macro cannot see enabled features. Only the scope tells
/// which one is meant.
fn trait_path() -> TokenStream {
    let found = |name: &str| match crate_name(name) {
        // Tests in docs and in `tests/` are crates of their own; unit tests need `extern crate self as avian3d`.
        Ok(FoundCrate::Itself) => Some(name.to_owned()),
        Ok(FoundCrate::Name(renamed)) => Some(renamed),
        Err(_) => None,
    };
    match (found("avian2d"), found("avian3d")) {
        (Some(name), None) | (None, Some(name)) => {
            let name = Ident::new(&name, Span::call_site());
            quote!(::#name::collision::collider::PhysicsLayer)
        }
        _ => quote!(PhysicsLayer),
    }
}

/// The implementation, or an error.
fn expand(input: &DeriveInput, path: &TokenStream) -> syn::Result<TokenStream> {
    let Data::Enum(data) = &input.data else {
        return Err(Error::new_spanned(&input.ident, "`PhysicsLayer` can only be derived for enums"));
    };
    for variant in &data.variants {
        if !matches!(variant.fields, Fields::Unit) {
            return Err(Error::new_spanned(variant, "a variant of a `PhysicsLayer` enum cannot have fields"));
        }
    }
    if let Some(extra) = data.variants.iter().nth(MAX_LAYERS) {
        let message = "a `PhysicsLayer` enum can have at most 32 variants: a mask has 32 bits";
        return Err(Error::new_spanned(extra, message));
    }
    let mut defaults = data.variants.iter().filter(|v| is_default(v));
    let Some(default) = defaults.next() else {
        let message = "a `PhysicsLayer` enum needs a variant marked `#[default]`: the layer of colliders \
                       without layers, bit 0";
        return Err(Error::new_spanned(&input.ident, message));
    };
    if let Some(second) = defaults.next() {
        return Err(Error::new_spanned(
            second,
            "only one variant of a `PhysicsLayer` enum can be `#[default]`",
        ));
    }

    let others = data.variants.iter().filter(|v| v.ident != default.ident);
    let ordered = core::iter::once(default).chain(others).map(|v| &v.ident);
    let bits = (0..data.variants.len()).map(|i| 1u32 << i);
    let all = u32::MAX >> (MAX_LAYERS - data.variants.len());
    let name = &input.ident;
    let (impl_generics, ty_generics, where_clause) = input.generics.split_for_impl();
    Ok(quote! {
        #[automatically_derived]
        impl #impl_generics #path for #name #ty_generics #where_clause {
            fn to_bits(&self) -> u32 {
                match self {
                    #(Self::#ordered => #bits,)*
                }
            }

            fn all_bits() -> u32 {
                #all
            }
        }
    })
}

/// Whether a variant has `#[default]`.
fn is_default(variant: &Variant) -> bool {
    variant.attrs.iter().any(|a| a.path().is_ident("default"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expanded(source: &str) -> Result<String, String> {
        let input = syn::parse_str(source).expect("the test's source is Rust");
        expand(&input, &quote!(P)).map(|t| t.to_string()).map_err(|e| e.to_string())
    }

    #[test]
    fn the_default_variant_is_bit_zero_wherever_it_stands() {
        let code = expanded("enum L { A, #[default] B, C }").expect("a correct enum");
        for arm in ["Self :: B => 1u32", "Self :: A => 2u32", "Self :: C => 4u32"] {
            assert!(code.contains(arm), "{arm} is missing in {code}");
        }
        assert!(code.contains("7u32"), "all three bits: {code}");
    }

    #[test]
    fn misuse_is_explained() {
        let message = |source: &str| expanded(source).expect_err(source);
        assert!(message("struct L;").contains("enums"));
        assert!(message("enum L { #[default] A, B(u32) }").contains("fields"));
        assert!(message("enum L { #[default] A, B {} }").contains("fields"));
        assert!(message("enum L { A, B }").contains("#[default]"));
        assert!(message("enum L {}").contains("#[default]"));
        assert!(message("enum L { #[default] A, #[default] B }").contains("only one"));
    }

    #[test]
    fn there_are_at_most_32_layers() {
        let with = |n: usize| {
            let rest: String = (1..n).map(|i| format!(", V{i}")).collect();
            expanded(&format!("enum L {{ #[default] V0{rest} }}"))
        };
        let code = with(32).expect("32 fit");
        assert!(code.contains(&format!("{}u32", u32::MAX)) && code.contains(&format!("{}u32", 1u32 << 31)));
        assert!(with(33).expect_err("33 do not").contains("32"));
    }
}
